// plain_block.h: how do many points of plain surfaces scatter light?
//
// Plain is a matte base, bare or under a clear and evenly rough boundary: what most surfaces are. They
// scatter by arithmetic and selects alone, so a block of points (block.h) is worked on by vectors. Each point
// gets the numbers that a Bsdf (bsdf.h) would give it, bit for bit; the formulas of the lobes are the same
// functions.
#pragma once

#include <optional>

#include "boxwood/render/bsdf.h"
#include "boxwood/render/light_sample.h"

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

class PlainBlock {
 public:
  PlainBlock();

  /// Puts a point of a plain material into place `i`, instead of a Bsdf with the same arguments. `color` is
  /// that of the base there.
  void set(int i, const PreparedMaterial& material, Vec3 color, const Surface& surface, Vec3 normal,
           Vec3 outgoing);

  /// What Bsdf::evaluate() gives for the directions of `lights`, and Bsdf::sample() for `choices` and `u`.
  void scatter(const Vec3s& toward_lights, const Floats& choices, const Vec2s& u);

  BsdfValue toward_light(int i) const { return {toward_value_[i], toward_pdf_[i]}; }
  std::optional<BsdfSample> next(int i) const {
    if (!(next_pdf_[i] > 0)) return std::nullopt;
    return BsdfSample{next_direction_[i], next_weight_[i], next_pdf_[i]};
  }

 private:
  PlainPoints points_;
  Vec3s toward_value_, next_direction_, next_weight_;
  Floats toward_pdf_{}, next_pdf_{};
};

}  // namespace boxwood::render
