#include "boxwood/render/plain_block.h"

#include "boxwood/core/every_cpu.h"
#include "boxwood/render/fresnel.h"

namespace boxwood::render {
namespace {

/// The loops, as one instruction set has them.
struct PlainKernels {
  void (*prepare)(PlainPoints& points);
  void (*evaluate)(const PlainPoints& points, const Vec3s& directions, Scattered& out);
  void (*sample)(const PlainPoints& points, const Floats& choices, const Vec2s& u, Scattered& out);
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
  for (int i = 0; i < kBlock; ++i) set(i, matte, splat(0.5f), up, up, up);
}

void PlainBlock::set(int i, const PreparedMaterial& material, Vec3 color, Vec3 geometric, Vec3 normal,
                     Vec3 outgoing) {
  const AlbedoRow* row =
      material.coat_over_base ? &material.coat_over_base->nearest(material.alpha) : nullptr;
  points_.normal.set(i, geometric);
  points_.shading_normal.set(i, normal);
  points_.outgoing_world.set(i, outgoing);
  points_.color.set(i, color);
  points_.ior[i] = material.ior;
  points_.boundary[i] = row != nullptr ? 1.0f : 0.0f;
  points_.alpha[i] = row != nullptr ? material.alpha : 1.0f;
  points_.mean[i] = row != nullptr ? row->mean() : 0;
  points_.rows[i] = row != nullptr ? row : &kNoBoundary;
}

void PlainBlock::scatter(const Vec3s& toward_lights, const Floats& choices, const Vec2s& u, Scattered& out) {
  const PlainKernels& loops = BOXWOOD_BEST(kKernels);
  loops.prepare(points_);
  loops.evaluate(points_, toward_lights, out);
  loops.sample(points_, choices, u, out);
}

}  // namespace boxwood::render
