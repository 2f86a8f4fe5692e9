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

constexpr int kWidths = 24;         // of a table for all widths
constexpr int kSamples = 1024;      // of each integral
constexpr int kFewerSamples = 256;  // where a table has many rows
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

float AlbedoRow::at(float cosine) const {
  // The angles crowd at the horizon, where albedos change fast: knot i stands at (i / n)^2.
  const float x = std::sqrt(min(max(cosine, 0.0f), 1.0f)) * (kAngles - 1);
  const int i = std::min(static_cast<int>(x), kAngles - 2);
  // Linear in the cosine between two knots.
  const float a = static_cast<float>(i * i), b = static_cast<float>((i + 1) * (i + 1));
  const float t = (x * x - a) / (b - a);
  return values_[i] * (1 - t) + values_[i + 1] * t;
}

AlbedoTable::AlbedoTable(Lobe lobe, float eta, float alpha) : rows_(alpha < 0 ? kWidths : 1) {
  const int samples = alpha < 0 ? kFewerSamples : kSamples;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const float x = static_cast<float>(r) / (kWidths - 1);
    const float width = max(alpha < 0 ? x * x : alpha, kLeastAlpha);
    AlbedoRow& row = rows_[r];
    for (int i = 0; i < AlbedoRow::kAngles; ++i) {
      const float root = static_cast<float>(i) / (AlbedoRow::kAngles - 1);
      const float cosine = max(root * root, 1e-4f);
      const Vec3 outgoing{std::sqrt(max(0.0f, 1 - cosine * cosine)), 0, cosine};
      double sum = 0;
      for (int s = 0; s < samples; ++s) {
        Sampler sampler(0, static_cast<std::uint32_t>(s));
        sum += weight(lobe, eta, width, outgoing, sampler.next_2d());
      }
      row.values_[i] = static_cast<float>(sum / samples);
    }
    // The mean of 2 cosine albedo, each piece between two knots exactly.
    double mean = 0;
    for (int i = 0; i + 1 < AlbedoRow::kAngles; ++i) {
      const auto knot = [](int k) {
        const double t = double(k) / (AlbedoRow::kAngles - 1);
        return t * t;
      };
      const double a = knot(i), b = knot(i + 1), fa = row.values_[i], fb = row.values_[i + 1];
      mean += (b - a) * (fa * (2 * a + b) + fb * (a + 2 * b)) / 3;
    }
    row.mean_ = static_cast<float>(mean);
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
