// Every scene that the program makes, with every builder, against a search without trees: equal, bit for bit.
#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/simd/validate.h"
#include "scene/scene_oracle.h"

namespace boxwood {
namespace {

/// From all around and from inside, a third of them along an axis, a third at the very corners of the bounds.
std::vector<Ray> rays_through(const Box3& bounds, int count) {
  Random random(23);
  const float size = length(bounds.extent());
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 inside = random.in_box(bounds.lower, bounds.upper);
    Ray ray{i % 2 ? inside : bounds.center() + random.direction() * size, 0, random.direction()};
    if (i % 2 == 0) ray.direction = inside - ray.origin;
    if (i % 3 == 1) {
      ray.direction = {0, 0, 0};
      ray.direction[i / 3 % 3] = i % 2 ? 1.0f : -1.0f;
      ray.origin = inside - ray.direction * size;
    }
    if (i % 3 == 2) ray.direction = bounds.corner(i / 3 % 8) - ray.origin;
    rays.push_back(ray);
  }
  return rays;
}

class MadeScenes : public ::testing::TestWithParam<const char*> {};

TEST_P(MadeScenes, AnswerAsIfTheyHadNoTrees) {
  const SceneDesc desc = gallery::make(GetParam());
  std::vector<Scene> scenes;
  for (const Method method : {Method::longest_axis, Method::binned_sah, Method::sweep_sah, Method::ploc}) {
    BuildOptions options;
    options.method = method;
    scenes.emplace_back(desc, options);
  }

  scenes.emplace_back(desc, BuildOptions::fast());
  scenes.emplace_back(desc, BuildOptions::best());  // cuts triangles
  for (const Scene& scene : scenes) ASSERT_EQ(simd::validate(scene.parts().world.triangles), "");

  std::size_t crossings = 0;
  std::vector<Hit> all;
  for (const Ray& ray : rays_through(scenes[0].bounds(), 120)) {
    const std::vector<Hit> expected = test::all_hits_without_trees(scenes[0], ray);
    crossings += expected.size();
    for (const Scene& scene : scenes) {
      scene.all_hits(ray, all);
      ASSERT_EQ(all.size(), expected.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].normal = {};
        ASSERT_EQ(all[i], expected[i]);
      }
      Hit closest = scene.closest_hit(ray);
      closest.normal = {};
      ASSERT_EQ(closest, expected.empty() ? Hit{} : expected[0]);
      ASSERT_EQ(scene.any_hit(ray), !expected.empty());
      ASSERT_EQ(scene.count_hits(ray), expected.size());
    }
  }
  EXPECT_GT(crossings, 0u);
}

INSTANTIATE_TEST_SUITE_P(Gallery, MadeScenes,
                         ::testing::Values("stilllife", "spheres:2000", "soup:5000", "terrain:32", "cornell",
                                           "city:500", "duplicates:1000"));

}  // namespace
}  // namespace boxwood
