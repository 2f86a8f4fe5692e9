#include "boxwood/render/plain_block.h"

#include "boxwood/render/fresnel.h"

namespace boxwood::render {
namespace {

/// The loops, as one instruction set has them.
struct PlainKernels {
  void (*prepare)(PlainPoints& points);
  void (*evaluate)(const PlainPoints& points, const Vec3s& directions, Vec3s& values, Floats& pdfs);
  void (*sample)(const PlainPoints& points, const Floats& choices, const Vec2s& u, Vec3s& directions,
                 Vec3s& weights, Floats& pdfs);
};

}  // namespace

#define BOXWOOD_LOOPS "boxwood/render/plain_block-inl.h"
#include "boxwood/core/every_cpu-inl.h"

namespace {

/// What a bare base reads in place of a boundary's albedo.
const AlbedoRow kNoBoundary{};

}  // namespace

PlainBlock::PlainBlock() {
  static const PreparedMaterial matte{Material{}};
  const Vec3 up{0, 0, 1};
  Surface surface{};
  surface.normal = up;
  for (int i = 0; i < kBlock; ++i) set(i, matte, splat(0.5f), surface, up, up);
}

void PlainBlock::set(int i, const PreparedMaterial& material, Vec3 color, const Surface& surface, Vec3 normal,
                     Vec3 outgoing) {
  const AlbedoRow* row =
      material.coat_over_base ? &material.coat_over_base->nearest(material.alpha) : nullptr;
  points_.normal.set(i, surface.normal);
  points_.shading_normal.set(i, normal);
  points_.outgoing_world.set(i, outgoing);
  points_.color.set(i, color);
  points_.ior[i] = material.ior;
  points_.boundary[i] = row != nullptr ? 1.0f : 0.0f;
  points_.alpha[i] = row != nullptr ? material.alpha : 1.0f;
  points_.mean[i] = row != nullptr ? row->mean() : 0;
  points_.rows[i] = row != nullptr ? row : &kNoBoundary;
}

void PlainBlock::scatter(const Vec3s& toward_lights, const Floats& choices, const Vec2s& u) {
  const PlainKernels& loops = has_avx2() ? avx2::kKernels : everywhere::kKernels;
  loops.prepare(points_);
  loops.evaluate(points_, toward_lights, toward_value_, toward_pdf_);
  loops.sample(points_, choices, u, next_direction_, next_weight_, next_pdf_);
}

}  // namespace boxwood::render
