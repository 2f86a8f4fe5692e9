// Closest hit and any hit on real scenes, against a search with no tree at all: equal, bit for bit.
#include "boxwood/scene/parts.h"
#include "boxwood/shape/gate.h"
#include "models.h"

namespace boxwood {
namespace {

using test::kModels;
using test::OnModel;

/// What one ray has found so far.
struct Found {
  float t_max;
  Hit best;
  Hit label;
  float limit() const { return t_max; }
  void report(const Crossing& c) {
    Hit hit = label;
    hit.t = c.t, hit.u = c.u, hit.v = c.v, hit.part = c.part;
    if (comes_before(hit, best)) best = hit;
  }
};

/// Shows every triangle of every instance to every ray, a few thousand triangles at a time so that they stay
/// in the cache.
std::vector<Hit> search_without_trees(const Scene& scene, const std::vector<Ray>& rays) {
  const Scene::Parts& parts = scene.parts();
  std::vector<Hit> hits(rays.size());
  default_executor().for_range(0, rays.size(), 500, [&](std::size_t begin, std::size_t end) {
    std::vector<PreparedRay> world;
    std::vector<Found> found;
    for (std::size_t i = begin; i < end; ++i) {
      world.emplace_back(rays[i], scene.bounds());
      found.push_back({world.back().t_max, {}, {}});
    }
    for (std::size_t instance = 0; instance < parts.instances.size(); ++instance) {
      const GeometryId geometry = parts.instances[instance].geometry;
      const auto& mesh = std::get<TriangleMesh>(parts.desc.geometries[geometry.value].shapes);
      const Affine3& world_from_object = parts.instances[instance].world_from_object;
      const bool is_moved = !(world_from_object == Affine3::identity());
      Box3 object_box;
      for (std::size_t k = 0; k < mesh.indices.size(); ++k)
        object_box.extend(triangle_of(mesh, PrimId(k)).box());
      const Box3 world_box = transform_box(world_from_object, object_box);
      const Affine3 back = inverse(world_from_object);

      std::vector<PreparedRay> local = world;
      std::vector<Interval> inside(world.size());
      for (std::size_t i = 0; is_moved && i < world.size(); ++i) {
        inside[i] = world[i].interval(world_box);
        local[i] = PreparedRay(back.point(world[i].origin), back.vector(world[i].direction), -kInfinity,
                               inside[i].is_empty() ? -kInfinity : kInfinity, object_box);
      }

      constexpr std::size_t kTile = 512;
      std::vector<Triangle> tile;
      for (std::size_t first = 0; first < mesh.indices.size(); first += kTile) {
        const std::size_t last = std::min(first + kTile, mesh.indices.size());
        tile.clear();
        for (std::size_t k = first; k < last; ++k) tile.push_back(triangle_of(mesh, PrimId(k)));
        for (std::size_t i = 0; i < world.size(); ++i) {
          if (!world[i].is_valid() || !local[i].is_valid()) continue;
          found[i].label.instance_id = InstanceId(instance);
          found[i].label.geometry_id = geometry;
          for (std::size_t k = 0; k < tile.size(); ++k) {
            found[i].label.primitive_id = PrimId(first + k);
            if (is_moved) {
              BoxGate<Found> gate(world[i], inside[i], found[i]);
              intersect_gated(local[i], tile[k], gate);
            } else {
              intersect_gated(local[i], tile[k], found[i]);
            }
          }
        }
      }
    }
    for (std::size_t i = begin; i < end; ++i) hits[i] = found[i - begin].best;
  });
  return hits;
}

class BruteForceOnModel : public OnModel {};

TEST_P(BruteForceOnModel, LoadsWhatTheFileHolds) {
  EXPECT_EQ(shown_primitive_count(scene().description()), GetParam().triangles);
}

TEST_P(BruteForceOnModel, ClosestHitAndAnyHitAreEqual) {
  const std::vector<Ray> rays = test::model_rays(scene(), 10'000);
  const std::vector<Hit> expected = search_without_trees(scene(), rays);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit hit = scene().closest_hit(rays[i]);
    hit.normal = {};
    ASSERT_EQ(hit, expected[i]) << "ray " << i;
    ASSERT_EQ(scene().any_hit(rays[i]), expected[i].is_hit()) << "ray " << i;
    hits += expected[i].is_hit();
  }
  EXPECT_GT(hits, rays.size() / 10);
}

INSTANTIATE_TEST_SUITE_P(Models, BruteForceOnModel, ::testing::ValuesIn(kModels), test::model_name);

}  // namespace
}  // namespace boxwood
