// Affine maps: inverses, cameras, and boxes that hold their image whatever the rounding.
#include "boxwood/core/affine.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

void expect_near(Vec3 a, Vec3 b, float tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance);
}

Affine3 some_map(Random& random, float translation) {
  Affine3 m = Affine3::rotation(random.direction(), random.uniform(-180, 180));
  m = m * Affine3::scale({random.uniform(0.5f, 2), random.uniform(-2, -0.5f), random.uniform(0.5f, 2)});
  m.y += m.x * random.uniform();  // and a shear
  m.origin = random.in_box(splat(-translation), splat(translation));
  return m;
}

TEST(Affine, MapsPointsAndVectors) {
  const Affine3 m = Affine3::translation({1, 2, 3}) * Affine3::scale({2, 3, 4});
  EXPECT_EQ(m.point({1, 1, 1}), (Vec3{3, 5, 7}));
  EXPECT_EQ(m.vector({1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_EQ(Affine3::identity().point({1, 2, 3}), (Vec3{1, 2, 3}));
  expect_near(Affine3::rotation({0, 0, 9}, 90).vector({1, 0, 0}), {0, 1, 0}, 1e-7f);
  expect_near(Affine3::rotation({2, 0, 0}, 90).vector({0, 1, 0}), {0, 0, 1}, 1e-7f);
  EXPECT_THROW(Affine3::rotation({0, 0, 0}, 90), std::invalid_argument);
}

TEST(Affine, ProductsReadFromRightToLeft) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Affine3 a = some_map(random, 3), b = some_map(random, 3);
    const Vec3 p = random.direction();
    expect_near((a * b).point(p), a.point(b.point(p)), 2e-5f);
  }
}

TEST(Affine, InverseUndoes) {
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    const Affine3 m = some_map(random, 5), back = inverse(m);
    const Vec3 p = random.in_box(splat(-3), splat(3));
    expect_near(back.point(m.point(p)), p, 5e-5f);
    expect_near(m.vector(back.vector(p)), p, 2e-5f);
  }
  // Exact where the numbers are.
  EXPECT_EQ(inverse(Affine3::translation({1, 2, 3})), Affine3::translation({-1, -2, -3}));
  EXPECT_EQ(inverse(Affine3::scale(0x1p40f)), Affine3::scale(0x1p-40f));
}

TEST(Affine, InverseRefusesWhatHasNone) {
  const float nan = std::nanf("");
  EXPECT_THROW(inverse(Affine3::scale({1, 0, 1})), std::invalid_argument);
  EXPECT_THROW(inverse(Affine3{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}, {}}), std::invalid_argument);
  EXPECT_THROW(inverse(Affine3::scale(nan)), std::invalid_argument);
  EXPECT_THROW(inverse(Affine3::translation({kInfinity, 0, 0})), std::invalid_argument);
  EXPECT_THROW(inverse(Affine3::scale(1e-39f)), std::invalid_argument) << "the inverse overflows";
}

TEST(Affine, DeterminantKnowsMirrorsAndVolume) {
  EXPECT_EQ(determinant(Affine3::scale({2, 3, 4})), 24);
  EXPECT_EQ(determinant(Affine3::scale({-1, 1, 1})), -1);
  EXPECT_NEAR(determinant(Affine3::rotation({1, 2, 3}, 77)), 1, 1e-6);
}

TEST(Affine, NormalsStayPerpendicular) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Affine3 world_from_object = some_map(random, 1);
    Vec3 n = normalize(random.direction()), t, b;
    orthonormal_basis(n, t, b);
    const Vec3 moved = normalize(transform_normal(inverse(world_from_object), n));
    EXPECT_NEAR(dot(moved, normalize(world_from_object.vector(t))), 0, 1e-5);
    EXPECT_NEAR(dot(moved, normalize(world_from_object.vector(b))), 0, 1e-5);
    EXPECT_GT(dot(moved, world_from_object.vector(n)), 0);
  }
}

TEST(Affine, LookAtIsARightHandedCamera) {
  const auto check = [](Vec3 eye, Vec3 target, Vec3 up) {
    const Affine3 m = Affine3::look_at(eye, target, up);
    EXPECT_EQ(m.origin, eye);
    expect_near(-m.z, normalize(target - eye), 1e-6f);
    EXPECT_NEAR(determinant(m), 1, 1e-5);
    EXPECT_NEAR(dot(m.x, m.y), 0, 1e-6);
    return m;
  };
  const Affine3 m = check({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  expect_near(m.x, {1, 0, 0}, 1e-7f);
  expect_near(m.y, {0, 1, 0}, 1e-7f);
  check({0, 5, 0}, {0, 0, 0}, {0, 1, 0});   // straight down
  check({0, -5, 0}, {0, 0, 0}, {0, 3, 0});  // straight up
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 eye = random.in_box(splat(-9), splat(9));
    const Affine3 camera = check(eye, random.direction(), {0, 0, 2});
    EXPECT_GE(camera.y.z, 0) << "up is up";
  }
}

/// The image of a point in long double, where the only rounding that matters is the float's own.
void exact_point(const Affine3& m, Vec3 p, long double out[3]) {
  for (int k = 0; k < 3; ++k)
    out[k] = (long double)m.x[k] * p.x + (long double)m.y[k] * p.y + (long double)m.z[k] * p.z + m.origin[k];
}

TEST(Affine, TransformedBoxHoldsTheImageOfEveryPoint) {
  Random random(5);
  for (int i = 0; i < 200'000; ++i) {
    Affine3 m = some_map(random, std::ldexp(1.0f, int(random.below(40)) - 10));
    const float scale = std::ldexp(1.0f, int(random.below(160)) - 80);
    m.x *= scale, m.y *= scale, m.z *= scale;
    Box3 box;
    const float size = std::ldexp(1.0f, int(random.below(60)) - 30);
    box.extend(random.in_box(splat(-size), splat(size)));
    if (random.below(4) != 0) box.extend(random.in_box(splat(-size), splat(size)));
    const Box3 image = transform_box(m, box);
    for (int which = 0; which < 9; ++which) {
      const Vec3 p = which < 8 ? box.corner(which) : random.in_box(box.lower, box.upper);
      long double exact[3];
      exact_point(m, p, exact);
      const Vec3 rounded = m.point(p);
      EXPECT_TRUE(image.contains(rounded));
      for (int k = 0; k < 3; ++k) {
        ASSERT_LE(image.lower[k], exact[k]);
        ASSERT_GE(image.upper[k], exact[k]);
      }
    }
  }
}

TEST(Affine, TransformedBoxIsNotMuchLargerThanItMustBe) {
  const Box3 image = transform_box(Affine3::translation({1, 2, 3}), {{0, 0, 0}, {1, 1, 1}});
  expect_near(image.lower, {1, 2, 3}, 1e-5f);
  expect_near(image.upper, {2, 3, 4}, 1e-5f);
  EXPECT_TRUE(transform_box(Affine3::rotation({1, 2, 3}, 50), Box3{}).is_empty());
}

}  // namespace
}  // namespace boxwood
