// oracle_shape_test.cpp: every query on every builder's tree over each kind of shape.
#include "oracle.h"
#include "support/shapes.h"

namespace boxwood {
namespace {

template <class Shape>
class OracleOfShapes : public testing::Test {};
using Kinds = testing::Types<Triangle, Quad, Sphere, Cuboid, Disk>;
TYPED_TEST_SUITE(OracleOfShapes, Kinds);

TYPED_TEST(OracleOfShapes, NoneOneAndTwo) {
  for (int count : {0, 1, 2})
    test::expect_equal_to_brute_force("random", test::random_shapes<TypeParam>(count, 3));
}

TYPED_TEST(OracleOfShapes, RandomOfMixedSize) {
  test::expect_equal_to_brute_force("random", test::random_shapes<TypeParam>(150, 1), {}, 3);
}

TYPED_TEST(OracleOfShapes, OnIntegerCoordinates) {
  test::expect_equal_to_brute_force("lattice", test::lattice_shapes<TypeParam>(100, 2), {}, 4);
}

TYPED_TEST(OracleOfShapes, Coincident) {
  test::expect_equal_to_brute_force("coincident", test::coincident_shapes<TypeParam>(60, 3), {}, 2);
}

TYPED_TEST(OracleOfShapes, Degenerate) {
  test::expect_equal_to_brute_force("degenerate", test::degenerate_shapes<TypeParam>(60, 4), {}, 3);
}

TYPED_TEST(OracleOfShapes, HugeTinyAndFarAway) {
  for (float scale : {1e-30f, 1e-12f, 1e12f, 1e30f})
    test::expect_equal_to_brute_force("scaled by " + std::to_string(scale),
                                      test::random_shapes<TypeParam>(40, 5, scale));
  test::expect_equal_to_brute_force("far away", test::random_shapes<TypeParam>(60, 6, 1, {1e4f, -2e4f, 5e3f}),
                                    {}, 2);

  // All scales in one tree.
  std::vector<TypeParam> mixed;
  for (float scale : {1e-20f, 1e-6f, 1.0f, 1e6f, 1e20f})
    for (const TypeParam& shape : test::random_shapes<TypeParam>(12, 7, scale)) mixed.push_back(shape);
  test::expect_equal_to_brute_force("all scales", mixed, {}, 3);
}

/// A careless shape of a user's own:
/// what it says of crossings and of its nearest point is far outside its box.
struct Sloppy {
  Cuboid block;
  float error;
  Box3 box() const { return block.box(); }
  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    struct Spoiler {
      std::remove_reference_t<Sink>& sink;
      float error;
      float limit() const { return kInfinity; }
      void report(Crossing crossing) {
        crossing.t += error;
        sink.report(crossing);
      }
    };
    block.intersect(ray, Spoiler{sink, error});
  }
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const { return block.normal(ray, crossing); }
  Vec3 closest_point(Vec3 p) const { return block.closest_point(p) + (p - block.closest_point(p)) * error; }
  bool overlaps(const Box3&) const { return true; }
};

TEST(OracleOfUsersShapes, CarelessOnesGetTheSameAnswersFromEveryTree) {
  Random random(8);
  std::vector<Sloppy> shapes;
  for (const Cuboid& block : test::lattice_shapes<Cuboid>(80, 9))
    shapes.push_back({block, random.uniform(-1, 1)});
  test::expect_equal_to_brute_force("careless", shapes, {}, 4);
}

}  // namespace
}  // namespace boxwood
