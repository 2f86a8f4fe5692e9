// oracle_instance_test.cpp: every query on every builder's tree over instances, groups, groups of instances
// of groups, and mixed shapes.
#include "boxwood/query/group.h"
#include "boxwood/shape/instance.h"
#include "boxwood/shape/shape.h"
#include "oracle.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood {
namespace {

enum class Kind { moved, turned, similar, stretched, sheared, mirrored, flattened };

Affine3 transform(Kind kind, Random& random) {
  const Affine3 move = Affine3::translation(random.in_box(splat(-2), splat(2)));
  const Affine3 turn = Affine3::rotation(random.direction(), random.uniform(0, 360));
  Affine3 shear;
  shear.y.x = random.uniform(-2, 2);
  shear.z.y = random.uniform(-2, 2);
  switch (kind) {
    case Kind::moved:
      return move;
    case Kind::turned:
      return move * turn;
    case Kind::similar:
      return move * turn * Affine3::scale(random.uniform(0.1f, 3));
    case Kind::stretched:
      return move * turn * Affine3::scale({random.uniform(0.1f, 3), 1, random.uniform(0.1f, 3)});
    case Kind::sheared:
      return move * turn * shear;
    case Kind::mirrored:
      return move * turn * Affine3::scale({1, -1, 1});
    case Kind::flattened:
      return move * turn * Affine3::scale({1, 1e-4f, 1});
  }
  return {};
}

constexpr Kind kSimilarities[] = {Kind::moved, Kind::turned, Kind::similar, Kind::mirrored};
constexpr Kind kAll[] = {Kind::moved,   Kind::turned,   Kind::similar,  Kind::stretched,
                         Kind::sheared, Kind::mirrored, Kind::flattened};

/// Only what rays ask: the face of a shape without closest_point,
/// for transforms under which that is not known.
template <ShapeType S>
struct RaysOnly {
  S shape;
  Box3 box() const { return shape.box(); }
  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    shape.intersect(ray, sink);
  }
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const { return shape.normal(ray, crossing); }
};

/// `count` placements of `objects`, in turn.
template <class Object>
std::vector<InstanceOf<Object>> placements(const std::vector<Object>& objects, std::span<const Kind> kinds,
                                           int count) {
  Random random(21);
  std::vector<InstanceOf<Object>> out;
  for (int i = 0; i < count; ++i)
    out.emplace_back(objects[static_cast<std::size_t>(i) % objects.size()],
                     transform(kinds[random.below(static_cast<std::uint32_t>(kinds.size()))], random));
  return out;
}

/// Corners of the objects' boxes where they stand in the world.
template <class Object>
std::vector<Vec3> corners(const std::vector<InstanceOf<Object>>& instances) {
  std::vector<Vec3> out;
  for (const auto& instance : instances)
    if (const Box3 box = instance.object().box(); !box.is_empty())
      for (int i = 0; i < 8; ++i) out.push_back(instance.world_from_object().point(box.corner(i)));
  return out;
}

template <class Object>
void check_instances(const std::string& name, const std::vector<Object>& objects, int count) {
  const auto similar = placements(objects, kSimilarities, count);
  test::expect_equal_to_brute_force(name + ", similarities", similar, corners(similar));
  const auto any = placements(objects, kAll, count);
  std::vector<RaysOnly<InstanceOf<Object>>> rays_only;
  for (const auto& instance : any) rays_only.push_back({instance});
  test::expect_equal_to_brute_force(name + ", any transform", rays_only, corners(any), 2);
}

template <class Shape>
Group<Shape> group_of(std::vector<Shape> shapes, std::uint64_t seed = 0) {
  Bvh bvh = seed == 0 ? build(boxes(shapes)) : test::random_tree(boxes(shapes), 3, seed);
  return {std::move(bvh), std::move(shapes)};
}

template <class Shape>
class OracleOfInstances : public testing::Test {};
using Kinds = testing::Types<Triangle, Quad, Sphere, Cuboid, Disk>;
TYPED_TEST_SUITE(OracleOfInstances, Kinds);

TYPED_TEST(OracleOfInstances, OfOneShape) {
  check_instances("random", test::random_shapes<TypeParam>(10, 31), 40);
  check_instances("lattice", test::lattice_shapes<TypeParam>(10, 32), 40);
  check_instances("degenerate", test::degenerate_shapes<TypeParam>(10, 33), 40);
}

TYPED_TEST(OracleOfInstances, OfGroups) {
  std::vector<Group<TypeParam>> groups;
  groups.push_back(group_of(test::random_shapes<TypeParam>(30, 34)));
  groups.push_back(group_of(test::lattice_shapes<TypeParam>(30, 35)));
  groups.push_back(group_of(test::coincident_shapes<TypeParam>(10, 36)));
  groups.push_back(group_of(std::vector<TypeParam>{}));
  check_instances("groups", groups, 25);
  test::expect_equal_to_brute_force("groups themselves", groups);
}

TEST(OracleOfInstances, OfGroupsOfInstancesOfGroups) {
  std::vector<Group<Quad>> inner;
  inner.push_back(group_of(test::lattice_shapes<Quad>(20, 37)));
  inner.push_back(group_of(test::random_shapes<Quad>(20, 38)));
  std::vector<Group<InstanceOf<Group<Quad>>>> outer;
  outer.push_back(group_of(placements(inner, kSimilarities, 6)));
  outer.push_back(group_of(placements(inner, kSimilarities, 9)));
  check_instances("nested", outer, 12);
}

TEST(OracleOfInstances, OfMeshes) {
  std::vector<Group<Triangle>> groups;
  groups.push_back(group_of(test::triangles(test::cube(2))));
  groups.push_back(group_of(test::triangles(test::icosphere(1))));
  check_instances("meshes", groups, 20);
}

// What stands below the instances is a tree as well, and must not show either.
TEST(OracleOfInstances, TheInnerTreeDoesNotShow) {
  const std::vector<Quad> shapes = test::lattice_shapes<Quad>(40, 39);
  std::vector<std::vector<ShapeHit>> answers;
  for (std::uint64_t seed : {0, 1, 2, 3}) {
    const std::vector inner{group_of(shapes, seed)};
    const std::vector middle{group_of(placements(inner, kAll, 8), seed)};
    const auto instances = placements(middle, kAll, 8);
    const reference::BruteForce brute(instances);
    Random random(40);
    answers.emplace_back();
    std::vector<ShapeHit> hits;
    for (const Ray& ray : test::hard_rays(corners(instances), brute.bounds(), 100, random)) {
      brute.all_hits(ray, hits);
      answers.back().insert(answers.back().end(), hits.begin(), hits.end());
      answers.back().push_back(brute.closest_hit(ray));
    }
    EXPECT_GT(hits.size() + answers.back().size(), 2000u);
    EXPECT_TRUE(answers.back() == answers.front());
  }
}

TEST(OracleOfMixedShapes, OneArrayOfAllKinds) {
  static const std::vector<Group<Triangle>> meshes{group_of(test::triangles(test::icosphere(1)))};
  std::vector<AnyShape> shapes;
  const auto add = [&](const auto& more) {
    for (const auto& shape : more) shapes.emplace_back(shape);
  };
  add(test::random_shapes<Triangle>(20, 41));
  add(test::lattice_shapes<Quad>(20, 42));
  add(test::random_shapes<Sphere>(20, 43));
  add(test::lattice_shapes<Cuboid>(20, 44));
  add(test::degenerate_shapes<Disk>(20, 45));
  add(meshes);

  // Instances know no overlap with a box; leave that question out by showing the first half only to it.
  test::expect_equal_to_brute_force("mixed", shapes, {}, 4);
  add(placements(meshes, kSimilarities, 5));
  std::vector<RaysOnly<AnyShape>> rays_only;
  for (const AnyShape& shape : shapes) rays_only.push_back({shape});
  test::expect_equal_to_brute_force("mixed with instances", rays_only, {}, 4);
}

}  // namespace
}  // namespace boxwood
