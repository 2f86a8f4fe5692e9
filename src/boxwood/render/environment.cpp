#include "boxwood/render/environment.h"

#include <algorithm>

#include "boxwood/render/emitter.h"
#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

float usable(float value) {
  return value > 0 && value < kInfinity ? value : 0;
}

}  // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : environment_(environment),
      world_from_environment_(environment.world_from_environment),
      environment_from_world_(inverse(environment.world_from_environment)),
      width_(environment.radiance.width),
      height_(environment.radiance.height) {
  // What each pixel holds: the integral of what radiance() mixes from it and its neighbours, by the area that
  // the row has on the sphere.
  running_.resize(std::size_t(width_) * height_);
  running_row_.resize(height_);
  double whole = 0;
  for (int y = 0; y < height_; ++y) {
    const double sine = std::sin(kPi * (y + 0.5) / height_);
    double row = 0;
    for (int x = 0; x < width_; ++x) {
      double mixed = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          mixed += (dx == 0 ? 0.75 : 0.125) * (dy == 0 ? 0.75 : 0.125) * brightness(pixel(x + dx, y + dy));
      row += mixed * sine;
      running_[std::size_t(y) * width_ + x] = static_cast<float>(row);
    }
    running_row_[y] = whole += row;
  }
  // The mean radiance is the integral over (u, v) of L 2 pi^2 sin, over 4 pi.
  strength_ = static_cast<float>(whole / (double(width_) * height_) * 2 * kPi * kPi / 4);
}

/// Around along a row; at the poles the row itself again.
Vec3 EnvironmentLight::pixel(int x, int y) const {
  y = std::clamp(y, 0, height_ - 1);
  x = x < 0 ? x + width_ : x >= width_ ? x - width_ : x;
  const float* p = environment_.radiance.at(std::clamp(x, 0, width_ - 1), y);
  return Vec3{usable(p[0]), usable(p[1]), usable(p[2])} * environment_.scale;
}

/// Where on the picture a direction is, in pixels.
Vec2 EnvironmentLight::picture_point(Vec3 local) const {
  const float longitude = std::atan2(local.y, local.x) / (2 * kPi);
  const float latitude = std::acos(min(max(local.z, -1.0f), 1.0f)) / kPi;
  return {(longitude < 0 ? longitude + 1 : longitude) * static_cast<float>(width_),
          latitude * static_cast<float>(height_)};
}

Vec3 EnvironmentLight::radiance(Vec3 direction) const {
  const Vec2 p = picture_point(normalize(environment_from_world_.vector(direction)));
  const float x = p.x - 0.5f, y = p.y - 0.5f;
  const float floor_x = std::floor(x), floor_y = std::floor(y), right = x - floor_x, down = y - floor_y;
  const int x0 = static_cast<int>(floor_x), y0 = static_cast<int>(floor_y);
  return (pixel(x0, y0) * (1 - right) + pixel(x0 + 1, y0) * right) * (1 - down) +
         (pixel(x0, y0 + 1) * (1 - right) + pixel(x0 + 1, y0 + 1) * right) * down;
}

/// Per unit of (u, v), the picture being 1 by 1.
float EnvironmentLight::density(int x, int y) const {
  const float* row = &running_[std::size_t(y) * width_];
  const double own = double(row[x]) - (x > 0 ? row[x - 1] : 0.0f);
  const double row_share = running_row_[y] - (y > 0 ? running_row_[y - 1] : 0);
  const double row_sum = row[width_ - 1];
  if (!(row_sum > 0) || !(running_row_.back() > 0)) return 0;
  return static_cast<float>(own / row_sum * (row_share / running_row_.back()) * width_ * height_);
}

EnvironmentLight::Sample EnvironmentLight::sample(Vec2 u) const {
  const double whole = running_row_.back();
  if (!(whole > 0)) return {{0, 0, 1}, 0};
  const double wanted_row = u.y * whole;
  const auto found_row = std::upper_bound(running_row_.begin(), running_row_.end(), wanted_row);
  const int y = std::min(static_cast<int>(found_row - running_row_.begin()), height_ - 1);
  const double before_row = y > 0 ? running_row_[y - 1] : 0, row_size = running_row_[y] - before_row;
  const float down = row_size > 0 ? static_cast<float>((wanted_row - before_row) / row_size) : 0.5f;

  const float* row = &running_[std::size_t(y) * width_];
  const float wanted = u.x * row[width_ - 1];
  const int x = std::min(static_cast<int>(std::upper_bound(row, row + width_, wanted) - row), width_ - 1);
  const float before = x > 0 ? row[x - 1] : 0, size = row[x] - before;
  const float right = size > 0 ? (wanted - before) / size : 0.5f;

  const float longitude = 2 * kPi * (static_cast<float>(x) + min(max(right, 0.0f), 1.0f)) / width_;
  const float latitude = kPi * (static_cast<float>(y) + min(max(down, 0.0f), 1.0f)) / height_;
  const float sine = std::sin(latitude);
  const Vec3 local{sine * std::cos(longitude), sine * std::sin(longitude), std::cos(latitude)};
  const Vec3 direction = normalize(world_from_environment_.vector(local));
  return {direction, sine > 0 ? density(x, y) / (2 * kPi * kPi * sine) : 0};
}

float EnvironmentLight::pdf(Vec3 direction) const {
  const Vec3 local = normalize(environment_from_world_.vector(direction));
  const Vec2 p = picture_point(local);
  const float sine = std::sqrt(max(0.0f, 1 - local.z * local.z));
  if (!(sine > 0)) return 0;
  return density(std::clamp(static_cast<int>(p.x), 0, width_ - 1),
                 std::clamp(static_cast<int>(p.y), 0, height_ - 1)) /
         (2 * kPi * kPi * sine);
}

}  // namespace boxwood::render
