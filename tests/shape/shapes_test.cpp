// shapes_test.cpp: the answers of the other shapes in cases
// that one can work out by hand, and users' own shapes.
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/query/all_hits.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/closest_point.h"
#include "boxwood/query/group.h"
#include "boxwood/query/overlap.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/disk.h"
#include "boxwood/shape/instance.h"
#include "boxwood/shape/quad.h"
#include "boxwood/shape/shape.h"
#include "boxwood/shape/sphere.h"

namespace boxwood {
namespace {

/// All crossings of one shape, through a tree of one leaf.
template <class Shape>
std::vector<ShapeHit> hits(const Shape& shape, const Ray& ray) {
  const std::vector<Shape> shapes{shape};
  return all_hits(build(boxes(shapes)), shapes, ray);
}

TEST(Sphere, EntersAndLeaves) {
  const auto found = hits(Sphere{{0, 0, 0}, 1}, {{0, 0, -3}, 0, {0, 0, 1}, kInfinity});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].t, 2);
  EXPECT_EQ(found[0].part, 0u);
  EXPECT_EQ(found[1].t, 4);
  EXPECT_EQ(found[1].part, 1u);
  EXPECT_EQ(hits(Sphere{{0, 0, 0}, 1}, {{0, 0, 0}, 0, {0, 0, 2}, kInfinity}).size(), 1u);  // from inside
}

TEST(Sphere, TangentsAndEmptySpheresAreNotHit) {
  EXPECT_TRUE(hits(Sphere{{0, 0, 0}, 1}, {{1, 0, -3}, 0, {0, 0, 1}, kInfinity}).empty());
  EXPECT_TRUE(hits(Sphere{{0, 0, 0}, 0}, {{0, 0, -3}, 0, {0, 0, 1}, kInfinity}).empty());
  EXPECT_TRUE(hits(Sphere{{0, 0, 0}, -1}, {{0, 0, -3}, 0, {0, 0, 1}, kInfinity}).empty());
  EXPECT_TRUE((Sphere{{0, 0, 0}, std::numeric_limits<float>::quiet_NaN()}.box().is_empty()));
}

TEST(Sphere, IsRightAtEveryScale) {
  for (float scale : {1e-30f, 1e-15f, 1e15f, 1e30f}) {
    const auto found = hits(Sphere{{0, 0, 0}, scale}, {{0, 0, -3 * scale}, 0, {0, 0, 1}, kInfinity});
    ASSERT_EQ(found.size(), 2u) << scale;
    EXPECT_FLOAT_EQ(found[0].t, 2 * scale);
    EXPECT_FLOAT_EQ(found[1].t, 4 * scale);
  }
}

TEST(Sphere, FarAwaySpheresKeepTheirNormals) {
  const Sphere ball{{0, 0, 0}, 1e-3f};
  const PreparedRay ray({{5e-4f, 0, -1e4f}, 0, {0, 0, 1}, kInfinity}, ball.box());
  const Vec3 n = ball.normal(ray, {1e4f, 0, 0, 0});  // t is rounded to steps of 1e-3, as large as the ball
  EXPECT_NEAR(n.x, 0.5f, 1e-5f);
  EXPECT_NEAR(n.z, -std::sqrt(0.75f), 1e-5f);
}

TEST(Sphere, TheSurfaceIsHollow) {
  const Sphere ball{{0, 0, 0}, 2};
  EXPECT_FALSE(ball.overlaps({splat(-1), splat(1)}));
  EXPECT_TRUE(ball.overlaps({{1, 0, 0}, {2, 0, 0}}));
  EXPECT_TRUE(ball.overlaps({splat(-3), splat(3)}));
  EXPECT_FALSE(ball.overlaps({splat(1.5f), splat(3)}));  // its corner is farther than 2
  EXPECT_EQ(ball.closest_point({1, 0, 0}), (Vec3{2, 0, 0}));
  EXPECT_EQ(ball.closest_point({0, -9, 0}), (Vec3{0, -2, 0}));
  EXPECT_EQ(distance(ball.closest_point({0, 0, 0}), {0, 0, 0}), 2);
}

TEST(Cuboid, EveryFaceHasItsPartAndNormal) {
  const Cuboid block{{-1, -2, -3}, {1, 2, 3}};
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      Vec3 from{0.5f, 0.25f, 0.125f}, direction{0, 0, 0};
      from[axis] = side * 10;
      direction[axis] = -side;
      const auto found = hits(block, {from, 0, direction, kInfinity});
      ASSERT_EQ(found.size(), 2u);
      EXPECT_EQ(found[0].t, 10 - block.upper[axis]);
      EXPECT_EQ(found[0].part, std::uint32_t(2 * axis + (side > 0)));
      EXPECT_EQ(found[1].part, std::uint32_t(2 * axis + (side < 0)));
      EXPECT_EQ(block.normal({{from, 0, direction, kInfinity}, block.box()}, found[0]), direction * -1.0f);
    }
}

TEST(Cuboid, RaysInAFaceAndAlongAnEdgeCrossAnEvenNumberOfTimes) {
  const Cuboid block{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(hits(block, {{-1, 0, 0.5f}, 0, {1, 0, 0}, kInfinity}).size(), 2u);
  EXPECT_EQ(hits(block, {{-1, 0, 0}, 0, {1, 0, -0.0f}, kInfinity}).size(), 2u);
  EXPECT_EQ(hits(block, {{-1, -1, -1}, 0, {1, 1, 1}, kInfinity}).size(), 2u);
  EXPECT_EQ(hits(block, {{-1, 1, 0.5f}, 0, {1, -1, 0}, kInfinity}).size() % 2, 0u);  // grazes an edge
  EXPECT_EQ(hits(Cuboid{{0, 0, 0}, {1, 1, 0}}, {{0.5f, 0.5f, -1}, 0, {0, 0, 1}, kInfinity}).size(),
            2u);  // flat
  EXPECT_TRUE(
      hits(Cuboid{{0, 0, 1}, {1, 1, 0}}, {{0.5f, 0.5f, -1}, 0, {0, 0, 1}, kInfinity}).empty());  // inside out
}

TEST(Cuboid, TheSurfaceIsHollow) {
  const Cuboid block{{-2, -2, -2}, {2, 2, 2}};
  EXPECT_FALSE(block.overlaps({splat(-1), splat(1)}));
  EXPECT_TRUE(block.overlaps({splat(-1), {1, 2, 1}}));
  EXPECT_TRUE(block.overlaps({splat(-5), splat(5)}));
  EXPECT_EQ(block.closest_point({1, 0.5f, 0}), (Vec3{2, 0.5f, 0}));
  EXPECT_EQ(block.closest_point({5, 5, 0}), (Vec3{2, 2, 0}));
}

TEST(Disk, HasARimAndTwoSides) {
  const Disk disk{{0, 0, 1}, {0, 0, -3}, 2};
  for (const float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(hits(disk, {{1, 1, 1 - 2 * side}, 0, {0, 0, side}, kInfinity}).size(), 1u);
    EXPECT_EQ(hits(disk, {{0, 2, 1 - 2 * side}, 0, {0, 0, side}, kInfinity}).size(), 1u);  // on the rim
    EXPECT_TRUE(hits(disk, {{1.5f, 1.5f, 1 - 2 * side}, 0, {0, 0, side}, kInfinity}).empty());
  }
  EXPECT_TRUE(hits(disk, {{-5, 0, 1}, 0, {1, 0, 0}, kInfinity}).empty());  // in the plane
  EXPECT_TRUE((Disk{{0, 0, 0}, {0, 0, 0}, 1}.box().is_empty()));
  EXPECT_EQ(disk.closest_point({6, 0, 9}), (Vec3{2, 0, 1}));
  EXPECT_EQ(disk.closest_point({1, 1, 9}), (Vec3{1, 1, 1}));
}

TEST(Disk, TouchingABoxIsOverlap) {
  const Disk disk{{0, 0, 0}, {1, 1, 1}, 1};
  EXPECT_TRUE(disk.overlaps({{0, 0, 0}, {1, 1, 1}}));  // by a corner in the plane
  EXPECT_FALSE(disk.overlaps({{0.01f, 0.01f, 0.01f}, {1, 1, 1}}));
  EXPECT_TRUE((Disk{{0, 0, 0}, {0, 0, 1}, 1}.overlaps({{0.6f, 0.6f, -1}, {2, 2, 1}})));
  EXPECT_FALSE(
      (Disk{{0, 0, 0}, {0, 0, 1}, 1}.overlaps({{0.8f, 0.8f, -1}, {2, 2, 1}})));  // in its box, past its rim
}

TEST(Quad, ParametersRunAlongTheSides) {
  const Quad quad{{0, 0, 0}, {2, 0, 0}, {2, 4, 0}, {0, 4, 0}};
  for (const Vec3 at : {Vec3{1.5f, 1, 0}, Vec3{0.5f, 3, 0}, Vec3{1, 2, 0}}) {
    const auto found = hits(quad, {{at.x, at.y, 1}, 0, {0, 0, -1}, kInfinity});
    ASSERT_EQ(found.size(), 1u);  // on the diagonal, too
    EXPECT_FLOAT_EQ(found[0].u, at.x / 2);
    EXPECT_FLOAT_EQ(found[0].v, at.y / 4);
  }
}

TEST(InstanceOf, MapsTheRayAndKeepsT) {
  const Sphere ball{{0, 0, 0}, 1};
  const InstanceOf<Sphere> moved(ball, Affine3::translation({10, 0, 0}) * Affine3::scale(2));
  const auto found = hits(moved, {{10, 0, -6}, 0, {0, 0, 2}, kInfinity});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_FLOAT_EQ(found[0].t, 2);
  EXPECT_FLOAT_EQ(found[1].t, 4);
  EXPECT_EQ(moved.closest_point({20, 0, 0}), (Vec3{12, 0, 0}));
}

TEST(InstanceOf, RefusesWhatItCannotDo) {
  const Sphere ball{{0, 0, 0}, 1};
  EXPECT_THROW(InstanceOf<Sphere>(ball, Affine3::scale({1, 0, 1})), std::invalid_argument);
  EXPECT_THROW(InstanceOf<Sphere>(ball, Affine3::scale({1, 2, 1})).closest_point({5, 5, 5}),
               std::logic_error);
  Affine3 shear;
  shear.y.x = 0.01f;
  EXPECT_THROW(InstanceOf<Sphere>(ball, shear).closest_point({5, 5, 5}), std::logic_error);
  EXPECT_NO_THROW(InstanceOf<Sphere>(ball, Affine3::scale({-3, 3, 3})).closest_point({5, 5, 5}));
}

TEST(IsSimilarity, HoldsForEveryRotation) {
  Random random(1);
  for (int i = 0; i < 1000; ++i)
    EXPECT_TRUE(is_similarity(Affine3::rotation(random.direction(), random.uniform(0, 360)) *
                              Affine3::scale(std::pow(10.0f, random.uniform(-15, 15)))));
  EXPECT_FALSE(is_similarity(Affine3::scale({1, 1, 0})));
  EXPECT_FALSE(is_similarity(Affine3::scale(0)));
}

TEST(Group, GivesTheNormalOfTheShapeThatWasHit) {
  const std::vector<Cuboid> blocks{{{-1, -1, -1}, {1, 1, 1}}, {{4, -1, -1}, {5, 1, 1}}};
  const Group<Cuboid> group(build(boxes(blocks)), blocks);
  const Ray ray{{10, 0.5f, 0.25f}, 0, {-1, 0, 0}, kInfinity};
  const auto found = hits(group, ray);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].part, 1u);
  EXPECT_EQ(found[3].part, 0u);
  const PreparedRay prepared(ray, group.box());
  for (int i = 0; i < 4; ++i) EXPECT_EQ(group.normal(prepared, found[i]), (Vec3{i % 2 ? -1.0f : 1.0f, 0, 0}));
}

TEST(Group, RefusesATreeOfOtherShapes) {
  EXPECT_THROW(Group<Sphere>(Bvh{}, std::vector<Sphere>(2)), std::invalid_argument);
}

// A user's own shape by concept: the part of the plane z = height inside a square.
struct Tile {
  Vec3 corner;
  float size;
  Box3 box() const { return {corner, corner + Vec3{size, size, 0}}; }
  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    const float t = (corner.z - ray.origin.z) / ray.direction.z;
    const float x = ray.origin.x + t * ray.direction.x - corner.x,
                y = ray.origin.y + t * ray.direction.y - corner.y;
    if (x >= 0 && x <= size && y >= 0 && y <= size && std::isfinite(t))
      sink.report({t, x / size, y / size, 0});
  }
  Vec3 normal(const PreparedRay&, const Crossing&) const { return {0, 0, 1}; }
};
static_assert(ShapeType<Tile> && !HasClosestPoint<Tile> && !HasOverlap<Tile>);

// A user's own shape by inheritance: a cylinder without ends around the z axis.
class Pipe : public Shape {
 public:
  explicit Pipe(float radius) : radius_(radius) {}
  Box3 box() const override { return {{-radius_, -radius_, -1}, {radius_, radius_, 1}}; }
  void intersect(const PreparedRay& ray, ShapeSink& sink) const override {
    const Vec3 o = ray.origin, d = ray.direction;
    const float a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y,
                c = o.x * o.x + o.y * o.y - radius_ * radius_;
    const float discriminant = b * b - a * c;
    if (!(discriminant > 0) || a == 0) return;
    for (std::uint32_t part = 0; part < 2; ++part) {
      const float t = (-b + (part ? 1.0f : -1.0f) * std::sqrt(discriminant)) / a;
      if (std::fabs(o.z + t * d.z) <= 1) sink.report({t, 0, 0, part});
    }
  }
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const override {
    const Vec3 p = ray.origin + ray.direction * crossing.t;
    return normalize({p.x, p.y, 0});
  }

 private:
  float radius_;
};

TEST(UsersShapes, JoinByConcept) {
  const std::vector<Tile> tiles{{{0, 0, 0}, 1}, {{0, 0, 5}, 1}, {{3, 0, 0}, 1}};
  const Bvh bvh = build(boxes(tiles));
  const ShapeHit hit = closest_hit(bvh, tiles, {{0.5f, 0.5f, 9}, 0, {0, 0, -1}, kInfinity});
  EXPECT_EQ(hit.prim_id, PrimId(1));
  EXPECT_EQ(hit.t, 4);
}

TEST(UsersShapes, JoinByInheritanceInOneArrayWithOthers) {
  const std::vector<AnyShape> shapes{std::make_shared<Pipe>(2.0f), Sphere{{0, 0, 0}, 1},
                                     Tile{{-3, -3, -1}, 6}, Cuboid{{5, 5, 5}, {6, 6, 6}}};
  const Bvh bvh = build(boxes(shapes));
  std::vector<std::uint32_t> met;
  for (const ShapeHit& hit : all_hits(bvh, shapes, {{-5, 0, 0.5f}, 0, {1, 0, 0}, kInfinity}))
    met.push_back(hit.prim_id.value);
  EXPECT_EQ(met, (std::vector<std::uint32_t>{0, 1, 1, 0}));

  EXPECT_TRUE(shapes[1].get().has_closest_point());
  EXPECT_FALSE(shapes[0].get().has_closest_point());
  EXPECT_THROW(shapes[0].closest_point({0, 0, 0}), std::logic_error);
  EXPECT_THROW(shapes[2].overlaps({{0, 0, 0}, {1, 1, 1}}), std::logic_error);
  EXPECT_THROW(AnyShape(std::shared_ptr<const Shape>()), std::invalid_argument);
}

TEST(Queries, OddQuestionsGetNoAnswer) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Sphere> balls{{{0, 0, 0}, 1}, {{5, 0, 0}, 1}};
  const Bvh bvh = build(boxes(balls));
  EXPECT_FALSE(closest_point(bvh, balls, {nan, 0, 0}).is_found());
  EXPECT_FALSE(closest_point(bvh, balls, {kInfinity, 0, 0}).is_found());
  EXPECT_FALSE(closest_point(bvh, balls, {0, 0, 0}, nan).is_found());
  EXPECT_FALSE(closest_point(bvh, balls, {0, 9, 0}, 7.9f).is_found());
  EXPECT_TRUE(closest_point(bvh, balls, {0, 9, 0}, 8).is_found());
  EXPECT_TRUE(overlap(bvh, balls, {0, 0, 0}, -1).empty());
  EXPECT_TRUE(overlap(bvh, balls, {0, 0, 0}, nan).empty());
  EXPECT_TRUE(overlap(bvh, balls, Box3{}).empty());
  EXPECT_TRUE(overlap(bvh, balls, Box3{{nan, 0, 0}, {1, 1, 1}}).empty());
  EXPECT_EQ(overlap(bvh, balls, {2.5f, 0, 0}, 1.5f), (std::vector{PrimId(0), PrimId(1)}));
  EXPECT_FALSE(closest_hit(Bvh{}, std::vector<Sphere>{}, {{0, 0, 0}, 0, {0, 0, 1}, kInfinity}).is_hit());
}

}  // namespace
}  // namespace boxwood
