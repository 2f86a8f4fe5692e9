// The ball around the few shapes that are not triangles never hides one of them.
#include "boxwood/scene/ball.h"

#include "scene/scene_checks.h"

namespace boxwood::test {
namespace {

TEST(Ball, LetsAllRaysPassThatComeNearAndFewOthers) {
  Random random(1);
  const Box3 box{{3, -1, 2}, {5, 0, 2.5f}}, bounds{splat(-30), splat(40)};
  const Ball ball(box, bounds);
  const float radius = 0.5f * length(box.extent());
  int passed = 0, kept = 0;
  for (int i = 0; i < 100000; ++i) {
    // From far and near, to a point of the box, and to one clear of the ball.
    const float far = std::exp2(random.uniform(-3, 24));
    const Ray near{box.center() + random.direction() * (far + radius), 0, {}};
    const Vec3 target = random.in_box(box.lower, box.upper) - near.origin;
    const float scale = std::exp2(random.uniform(-20, 20));
    const Ray towards{near.origin, 0, target * scale};
    EXPECT_TRUE(ball.may_meet(towards, kInfinity));
    EXPECT_TRUE(ball.may_meet(towards, 1.0001f / scale));
    if (far > 1000) continue;
    const Vec3 beside = normalize(cross(target, random.direction())) * (3 * radius + 0.01f * far);
    ++passed;
    kept += ball.may_meet({near.origin, 0, target + beside * 2}, kInfinity);  // past it
    kept += ball.may_meet({near.origin, 0, -target}, kInfinity);              // away from it
    kept += far > 10 * radius && ball.may_meet(towards, 0.5f / scale);        // not as far
  }
  EXPECT_LT(kept, passed / 20);
}

/// Triangles, for what a ball leaves to them.
TriangleMesh soup() {
  Random random(5);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Vec3 center = random.in_box(splat(-10), splat(10));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.in_box(splat(-1), splat(1)));
    mesh.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// How many of the rays hit something else than the soup, geometry 0.
std::size_t expect_answers_as_without_trees(const Scene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> batch(rays.size());
  scene.closest_hit(rays, batch);
  std::size_t met = 0, differing = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<Hit> expected = all_hits_without_trees(scene, rays[i]);
    Hit found = scene.closest_hit(rays[i]);
    differing += !(found == batch[i]);
    found.normal = {};
    differing += !(found == (expected.empty() ? Hit{} : expected[0]));
    differing += scene.any_hit(rays[i]) == expected.empty();
    met += found.is_hit() && found.geometry_id.value > 0;
  }
  EXPECT_EQ(differing, 0u);
  return met;
}

TEST(Ball, ScenesWithAFewShapesAnswerAsIfTheyHadNoTrees) {
  Random random(6);
  SceneDesc desc;
  const Sphere sphere{{4, 4, 4}, 0.25f};
  const Disk disk{{4.5f, 4, 4}, {0, 1, 0}, 0.3f};
  desc.add({desc.add(soup()), Affine3::identity(), {}});
  desc.add({desc.add(std::vector<Sphere>{sphere}), Affine3::identity(), {}});
  desc.add({desc.add(std::vector<Disk>{disk}), Affine3::identity(), {}});
  desc.add({desc.add(std::vector<Cuboid>{{{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}}}),
            Affine3::translation({4, 4.5f, 4}) * Affine3::rotation({1, 2, 3}, 40),
            {}});
  const Scene scene(std::move(desc));
  std::vector<Ray> rays = mixed_rays(scene.bounds(), 4000, 9);
  for (int i = 0; i < 20000; ++i) {
    // Along the outlines of the sphere and the disk, from far and near; some end about there.
    const Vec3 way = random.direction(), beside = normalize(cross(way, random.direction()));
    const float far = std::exp2(random.uniform(-2, 20));
    const Vec3 edge = i % 2 ? sphere.center + beside * sphere.radius
                            : disk.center + normalize(cross(disk.facing, beside)) * disk.radius;
    rays.push_back({edge - way * far, 0, way, i % 3 ? kInfinity : far * random.uniform(0.9999f, 1.0001f)});
  }
  EXPECT_GT(expect_answers_as_without_trees(scene, rays), 3000u);
}

TEST(Ball, RaysThatTouchTheCornersOfABlockTouchItsBallToo) {
  Random random(7);
  SceneDesc desc;
  desc.add(soup());
  const Cuboid block{{3, 4, 3}, {3.5f, 4.5f, 3.25f}};
  desc.add(std::vector<Cuboid>{block});
  const Scene scene(std::move(desc));
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const Box3 box{block.lower, block.upper};
    const Vec3 corner = box.corner(i % 8), out = normalize(corner - box.center());
    const Vec3 way = normalize(cross(out, random.direction()));
    const float far = std::exp2(random.uniform(-4, 18));
    rays.push_back({corner - way * far, 0, way, i % 3 ? kInfinity : far * random.uniform(0.9999f, 1.0001f)});
  }
  EXPECT_GT(expect_answers_as_without_trees(scene, rays), 2000u);
}

}  // namespace
}  // namespace boxwood::test
