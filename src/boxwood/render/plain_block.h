// plain_block.h: how do many points of plain surfaces scatter light?
//
// Plain is a matte base, bare or under a clear and evenly rough boundary: what most surfaces are. They
// scatter by arithmetic and selects alone, so a block of points (block.h) is worked on by vectors. Each point
// gets the numbers that a Bsdf (bsdf.h) would give it, bit for bit; the formulas of the lobes are the same
// functions.
#pragma once

#include <optional>

#include "boxwood/core/block.h"
#include "boxwood/render/bsdf.h"

namespace boxwood::render {

/// The points, and what is worked out for them on the way. Places that no point fills hold a grey, matte one.
struct PlainPoints {
  // What a surface is, and who looks at it.
  Vec3s normal, shading_normal, outgoing_world, color;
  Floats alpha{}, ior{};
  Floats boundary{};  // 1 for a boundary, 0 for a bare base
  Floats mean{};      // the mean albedo of the boundary
  std::array<const AlbedoRow*, kBlock> rows{};

  // The frame of the surface, and the light that each lobe gets.
  Vec3s x_axis, y_axis, z_axis, geometric, outgoing, diffuse;
  Floats passes{}, specular_chance{}, diffuse_chance{};
};

/// What the points of a block do to light.
struct Scattered {
  // That comes from where they were asked about; and
  Vec3s toward_value;
  Floats toward_pdf{};
  // where the light that they send on may have come from, if it does at all.
  Integers has_next{};
  Vec3s direction, weight;
  Floats pdf{};
  Integers is_perfect{}, is_transmission{};

  BsdfValue toward_light(int i) const { return {toward_value[i], toward_pdf[i]}; }
  std::optional<BsdfSample> next(int i) const {
    if (has_next[i] == 0) return std::nullopt;
    return BsdfSample{direction[i], weight[i], pdf[i], is_perfect[i] != 0, is_transmission[i] != 0};
  }
  void set_toward_light(int i, const BsdfValue& value) {
    toward_value.set(i, value.value);
    toward_pdf[i] = value.pdf;
  }
  void set_next(int i, const std::optional<BsdfSample>& next) {
    has_next[i] = next ? 1 : 0;
    if (!next) return;
    direction.set(i, next->direction);
    weight.set(i, next->weight);
    pdf[i] = next->pdf;
    is_perfect[i] = next->is_perfect;
    is_transmission[i] = next->is_transmission;
  }
};

class PlainBlock {
 public:
  PlainBlock();

  /// Puts a point of a plain material into place `i`, instead of a Bsdf with the same arguments. `color` is
  /// that of the base there, `geometric` the normal of the surface.
  void set(int i, const PreparedMaterial& material, Vec3 color, Vec3 geometric, Vec3 normal, Vec3 outgoing);

  /// What Bsdf::evaluate() gives for the directions of `toward_lights`, and Bsdf::sample() for `choices` and
  /// `u`.
  void scatter(const Vec3s& toward_lights, const Floats& choices, const Vec2s& u, Scattered& out);

 private:
  PlainPoints points_;
};

}  // namespace boxwood::render
