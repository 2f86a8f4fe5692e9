#include "boxwood/render/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

float clamp_cosine(float c) {
  return min(max(c, -1.0f), 1.0f);
}
float sine_of(float cosine) {
  return std::sqrt(max(0.0f, 1 - cosine * cosine));
}

/// cos(max(0, a - b)) for two angles in [0, pi], by their cosines.
float cosine_of_difference(float cos_a, float cos_b) {
  if (cos_a > cos_b) return 1;
  return cos_a * cos_b + sine_of(cos_a) * sine_of(cos_b);
}

/// Bounds of both: the box around both, and a cone around both cones.
LightBounds join(const LightBounds& a, const LightBounds& b) {
  if (!(a.strength > 0)) return b;
  if (!(b.strength > 0)) return a;
  LightBounds out;
  out.box = a.box;
  out.box.extend(b.box);
  out.strength = a.strength + b.strength;
  out.is_two_sided = a.is_two_sided || b.is_two_sided;
  out.cos_spread = min(a.cos_spread, b.cos_spread);

  const LightBounds &wide = a.cos_facing <= b.cos_facing ? a : b, &narrow = &wide == &a ? b : a;
  const float wide_angle = std::acos(clamp_cosine(wide.cos_facing)),
              narrow_angle = std::acos(clamp_cosine(narrow.cos_facing));
  const float between = std::acos(clamp_cosine(dot(wide.axis, narrow.axis)));
  out.axis = wide.axis;
  out.cos_facing = wide.cos_facing;
  if (between + narrow_angle <= wide_angle) return out;  // one holds the other
  const float angle = 0.5f * (wide_angle + between + narrow_angle);
  const Vec3 across = cross(wide.axis, narrow.axis);
  if (angle >= kPi || !(length_squared(across) > 1e-12f)) {
    out.cos_facing = -1;
    return out;
  }
  // Turn the axis of the wide cone towards the other.
  const Vec3 side = cross(normalize(across), wide.axis);
  const float turn = angle - wide_angle;
  out.axis = normalize(wide.axis * std::cos(turn) + side * std::sin(turn));
  // A little wider, for rounding.
  out.cos_facing = max(-1.0f, std::cos(angle) - 1e-5f);
  return out;
}

/// What a node costs: its strength, times the area of its box, times the solid angle that it shines into.
double cost(const LightBounds& b) {
  if (!(b.strength > 0)) return 0;
  const double facing = std::acos(clamp_cosine(b.cos_facing)), spread = std::acos(clamp_cosine(b.cos_spread));
  const double all = std::min(facing + spread, double(kPi));
  const double sine = std::sin(facing);
  const double solid =
      2 * kPi * (1 - b.cos_facing) +
      kPi / 2 * (2 * all * sine - std::cos(facing - 2 * all) - 2 * facing * sine + b.cos_facing);
  const Vec3 e = b.box.extent();
  // Lights in a row have no area; their length counts a little.
  const double area =
      2 * (double(e.x) * e.y + double(e.y) * e.z + double(e.z) * e.x) + 1e-3 * length_squared(e);
  return b.strength * std::max(solid, 1e-6) * area;
}

/// An estimate of the irradiance that the lights could cause at `from` at most.
float importance_of(const LightBounds& b, const Receiver& from) {
  const Vec3 to_light = b.box.center() - from.position;
  const float radius_squared = 0.25f * length_squared(b.box.extent());
  const float distance_squared = length_squared(to_light);
  // Inside the bounding sphere the distance to its middle says nothing, and neither do directions.
  const bool is_inside = distance_squared <= radius_squared;
  const float cos_reach = is_inside ? -1 : std::sqrt(max(0.0f, 1 - radius_squared / distance_squared));
  const Vec3 direction = distance_squared > 0 ? to_light / std::sqrt(distance_squared) : b.axis;

  float result = b.strength / max(max(distance_squared, radius_squared), 1e-30f);
  float cos_facing = dot(b.axis, -direction);
  if (b.is_two_sided) cos_facing = std::fabs(cos_facing);
  const float cos_away = cosine_of_difference(clamp_cosine(cos_facing), b.cos_facing);
  const float cos_emitted = cosine_of_difference(cos_away, cos_reach);
  if (cos_emitted <= b.cos_spread) return 0;
  // Lights that shine all around do not fall off with the angle.
  if (b.cos_facing > -1) result *= max(cos_emitted, 0.05f);

  if (length_squared(from.normal) > 0) {
    const float cos_in = cosine_of_difference(clamp_cosine(dot(direction, from.normal)), cos_reach);
    if (!(cos_in > 0)) return 0;
    result *= cos_in;
  }
  return result;
}

}  // namespace

LightTree::LightTree(const std::vector<LightBounds>& lights) : leaf_of_light_(lights.size()) {
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::erase_if(order, [&](std::uint32_t i) { return !(lights[i].strength > 0); });
  nodes_.reserve(2 * order.size());
  if (!order.empty()) build(lights, order.data(), order.data() + order.size(), 0);
}

std::uint32_t LightTree::build(const std::vector<LightBounds>& lights, std::uint32_t* begin,
                               std::uint32_t* end, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_[index].parent = parent;
  if (end - begin == 1) {
    nodes_[index].bounds = lights[*begin];
    nodes_[index].light = *begin;
    leaf_of_light_[*begin] = index;
    return index;
  }

  // Where to cut: the cheapest of a few planes across each axis (the heuristic of section 4.4).
  constexpr int kBins = 12;
  Box3 centers;
  for (const std::uint32_t* i = begin; i != end; ++i) centers.extend(lights[*i].box.center());
  double best = kInfinity;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](std::uint32_t light, int axis) {
    const float extent = centers.upper[axis] - centers.lower[axis];
    const float x = (lights[light].box.center()[axis] - centers.lower[axis]) / extent;
    return std::clamp(static_cast<int>(x * kBins), 0, kBins - 1);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.upper[axis] > centers.lower[axis])) continue;
    std::array<LightBounds, kBins> bins{};
    std::array<LightBounds, kBins> right{};
    for (const std::uint32_t* i = begin; i != end; ++i) {
      LightBounds& bin = bins[bin_of(*i, axis)];
      bin = join(bin, lights[*i]);
    }
    for (int b = kBins - 1; b > 0; --b) right[b] = b + 1 < kBins ? join(bins[b], right[b + 1]) : bins[b];
    LightBounds left;
    for (int b = 1; b < kBins; ++b) {
      left = join(left, bins[b - 1]);
      if (!(left.strength > 0) || !(right[b].strength > 0)) continue;
      const double sum = cost(left) + cost(right[b]);
      if (sum < best) {
        best = sum;
        best_axis = axis;
        best_bin = b;
      }
    }
  }
  std::uint32_t* middle = begin + (end - begin) / 2;
  if (best_axis >= 0)
    middle = std::stable_partition(begin, end,
                                   [&](std::uint32_t light) { return bin_of(light, best_axis) < best_bin; });
  if (middle == begin || middle == end) middle = begin + (end - begin) / 2;

  build(lights, begin, middle, index);
  const std::uint32_t second = build(lights, middle, end, index);
  nodes_[index].second = second;
  nodes_[index].bounds = join(nodes_[index + 1].bounds, nodes_[second].bounds);
  return index;
}

float LightTree::importance(const Receiver& from) const {
  return is_empty() ? 0 : importance_of(nodes_[0].bounds, from);
}

std::optional<LightTree::Choice> LightTree::choose(const Receiver& from, float& choice) const {
  if (is_empty()) return std::nullopt;
  std::uint32_t index = 0;
  float probability = 1;
  while (nodes_[index].second != 0) {
    const float first = importance_of(nodes_[index + 1].bounds, from),
                second = importance_of(nodes_[nodes_[index].second].bounds, from);
    const float sum = first + second;
    if (!(sum > 0) || !(sum < kInfinity)) return std::nullopt;
    const float share = first / sum;
    const bool is_first = choice < share;
    choice = is_first ? choice / share : (choice - share) / (1 - share);
    choice = min(max(choice, 0.0f), 0x1.fffffep-1f);
    probability *= is_first ? share : second / sum;
    index = is_first ? index + 1 : nodes_[index].second;
  }
  return Choice{nodes_[index].light, probability};
}

float LightTree::probability(std::uint32_t light, const Receiver& from) const {
  // From the leaf up to the root.
  float probability = 1;
  std::uint32_t index = leaf_of_light_[light];
  if (nodes_.empty() || nodes_[index].second != 0 || nodes_[index].light != light) return 0;
  while (index != 0) {
    const std::uint32_t parent = nodes_[index].parent;
    const float first = importance_of(nodes_[parent + 1].bounds, from),
                second = importance_of(nodes_[nodes_[parent].second].bounds, from);
    const float sum = first + second;
    if (!(sum > 0) || !(sum < kInfinity)) return 0;
    probability *= (index == parent + 1 ? first : second) / sum;
    index = parent;
  }
  return probability;
}

}  // namespace boxwood::render
