// cornell.cpp: the Cornell box, as measured at the Program of Computer Graphics, Cornell University.
//
// Goral, Torrance, Greenberg and Battaile, "Modeling the Interaction of Light Between Diffuse Surfaces",
// SIGGRAPH 1984; the geometry is the later data set with two blocks, in millimetres. It lies open towards -z,
// where the camera stands. The colors are the measured spectra as linear RGB.

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

namespace {

void add_quads(SceneDesc& desc, const char* name, std::vector<Quad> quads, MaterialId material) {
  desc.add(Geometry{std::move(quads), material, {}, name});
}

/// The top of a block and its four sides down to the floor. Corners counter-clockwise as seen from above.
std::vector<Quad> block(const Vec3 (&top)[4]) {
  const auto on_floor = [](Vec3 p) { return Vec3{p.x, 0, p.z}; };
  std::vector<Quad> quads{{top[0], top[1], top[2], top[3]}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 a = top[i], b = top[(i + 1) % 4];
    quads.push_back({a, on_floor(a), on_floor(b), b});
  }
  return quads;
}

}  // namespace

SceneDesc make_cornell() {
  SceneDesc desc;
  const MaterialId white = add_paint(desc, {"white", {0.725f, 0.710f, 0.680f}});
  const MaterialId red = add_paint(desc, {"red", {0.630f, 0.065f, 0.050f}});
  const MaterialId green = add_paint(desc, {"green", {0.140f, 0.450f, 0.091f}});
  const MaterialId lamp =
      desc.add(Material{.name = "lamp", .color = {0.78f, 0.78f, 0.78f}, .emission = {29, 24, 17}});

  // The room. Seen by the camera the red wall, at large x, is on the left.
  add_quads(desc, "floor, ceiling, back",
            {{{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}},
             {{556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}},
             {{549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}}},
            white);
  add_quads(desc, "right wall", {{{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}}}, green);
  add_quads(desc, "left wall",
            {{{552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}}}, red);

  add_quads(desc, "short block", block({{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}),
            white);
  add_quads(desc, "tall block", block({{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}),
            white);

  // The lamp hangs a hair below the ceiling and shines down.
  add_quads(desc, "lamp", {{{343, 548.7f, 227}, {343, 548.7f, 332}, {213, 548.7f, 332}, {213, 548.7f, 227}}},
            lamp);

  // A lens of 35 mm before film of 25 mm: 2 atan(12.5 / 35).
  desc.camera = look_at_camera({278, 273, -800}, {278, 273, 0}, 39.31f, 720, 720);
  return desc;
}

}  // namespace boxwood::gallery
