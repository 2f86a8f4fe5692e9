#include "boxwood/render/albedo_table.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "boxwood/render/fresnel.h"
#include "boxwood/render/sampler.h"
#include "boxwood/render/sheen.h"

namespace boxwood::render {
namespace {

constexpr int kWidths = 24;          // of a table for all widths
constexpr int kSamples = 4096;       // of each integral
constexpr int kFewerSamples = 1024;  // where a table has many rows
constexpr float kLeastAlpha = 0.001f;

/// The weight of one visible normal: what a path would carry on in the direction that it leads to.
float weight(AlbedoTable::Lobe lobe, float eta, float alpha, Vec3 outgoing, Vec2 u) {
  if (lobe == AlbedoTable::Lobe::sheen) {
    const Vec3 incoming = uniform_cone(u, 1);
    return sheen_lobe(alpha, outgoing, incoming) * 2 * kPi;
  }
  const Ggx ggx{alpha};
  const Vec3 half = ggx.sample_visible_normal(outgoing, u);
  const float cosine = min(dot(outgoing, half), 1.0f);
  const Vec3 reflected = half * (2 * cosine) - outgoing;
  const float reflection = reflected.z > 0 ? ggx.masking(outgoing, reflected) : 0;
  if (lobe == AlbedoTable::Lobe::reflection) return reflection;
  const float share = fresnel_dielectric(max(cosine, 0.0f), eta);
  if (lobe == AlbedoTable::Lobe::coat) return share * reflection;
  const Vec3 refracted = refract(outgoing, half, 1 / eta);
  const float transmission = refracted.z < 0 ? ggx.masking(outgoing, refracted) : 0;
  return share * reflection + (1 - share) * transmission;
}

}  // namespace

namespace {

float knot_cosine(int i, int angles) {
  const float root = static_cast<float>(i) / static_cast<float>(angles - 1);
  return root * root;
}

}  // namespace

float AlbedoRow::at(float cosine) const {
  const Place k(cosine);
  return values_[k.below] * (1 - k.share) + values_[k.below + 1] * k.share;
}

void AlbedoRow::finish() {
  // The mean of 2 cosine albedo, each piece between two knots exactly.
  double mean = 0, missing = 0;
  for (int i = 0; i + 1 < kAngles; ++i) {
    const double a = knot_cosine(i, kAngles), b = knot_cosine(i + 1, kAngles);
    const double fa = values_[i], fb = values_[i + 1];
    const double piece = (b - a) * (fa * (2 * a + b) + fb * (a + 2 * b)) / 3;
    mean += piece;
    missing += std::max(b * b - a * a - piece, 1e-9);
    running_missing_[i + 1] = static_cast<float>(missing);
  }
  mean_ = static_cast<float>(mean);
  for (float& sum : running_missing_) sum /= static_cast<float>(missing);
}

float AlbedoRow::sample_missing(float u) const {
  const auto found = std::upper_bound(running_missing_.begin(), running_missing_.end(), u);
  const int above = std::clamp(static_cast<int>(found - running_missing_.begin()), 1, kAngles - 1);
  const float before = running_missing_[above - 1], size = running_missing_[above] - before;
  const float share = size > 0 ? min(max((u - before) / size, 0.0f), 1.0f) : 0.5f;
  return knot_cosine(above - 1, kAngles) * (1 - share) + knot_cosine(above, kAngles) * share;
}

float AlbedoRow::missing_density(float cosine) const {
  const Place k(cosine);
  return (running_missing_[k.below + 1] - running_missing_[k.below]) /
         (knot_cosine(k.below + 1, kAngles) - knot_cosine(k.below, kAngles));
}

AlbedoTable::AlbedoTable(Lobe lobe, float eta, float alpha) : rows_(alpha < 0 ? kWidths : 1) {
  const int samples = alpha < 0 ? kFewerSamples : kSamples;
  std::vector<Vec2> points;
  for (int s = 0; s < samples; ++s) points.push_back(Sampler(0, static_cast<std::uint32_t>(s)).next_2d());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const float x = static_cast<float>(r) / (kWidths - 1);
    const float width = max(alpha < 0 ? x * x : alpha, kLeastAlpha);
    AlbedoRow& row = rows_[r];
    for (int i = 0; i < AlbedoRow::kAngles; ++i) {
      const float root = static_cast<float>(i) / (AlbedoRow::kAngles - 1);
      const float cosine = max(root * root, 1e-4f);
      const Vec3 outgoing{std::sqrt(max(0.0f, 1 - cosine * cosine)), 0, cosine};
      double sum = 0;
      for (const Vec2 u : points) sum += weight(lobe, eta, width, outgoing, u);
      row.values_[i] = static_cast<float>(sum / samples);
    }
    row.finish();
  }
}

AlbedoTable::Place AlbedoTable::place(float alpha) const {
  if (rows_.size() == 1) return {rows_[0], rows_[0], 0};
  const float x = std::sqrt(min(max(alpha, 0.0f), 1.0f)) * (kWidths - 1);
  const int i = std::min(static_cast<int>(x), kWidths - 2);
  return {rows_[i], rows_[i + 1], x - static_cast<float>(i)};
}

float AlbedoTable::at(float alpha, float cosine) const {
  const Place p = place(alpha);
  return p.share > 0 ? p.below.at(cosine) * (1 - p.share) + p.above.at(cosine) * p.share : p.below.at(cosine);
}

const AlbedoRow& AlbedoTable::nearest(float alpha) const {
  const Place p = place(alpha);
  return p.share < 0.5f ? p.below : p.above;
}

float AlbedoTable::mean(float alpha) const {
  const Place p = place(alpha);
  return p.below.mean() * (1 - p.share) + p.above.mean() * p.share;
}

std::shared_ptr<const AlbedoTable> AlbedoTable::get(Lobe lobe, float eta, float alpha) {
  static std::mutex mutex;
  static std::map<std::tuple<Lobe, float, float>, std::shared_ptr<const AlbedoTable>> tables;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const AlbedoTable>& table = tables[{lobe, eta, alpha}];
  if (!table) table = std::make_shared<const AlbedoTable>(lobe, eta, alpha);
  return table;
}

}  // namespace boxwood::render
