#include "bench_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "boxwood/core/random.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/render/camera.h"
#include "boxwood/render/warp.h"

namespace boxwood::app {
namespace {

constexpr int kTile = 8;
constexpr float kOcclusionLength = 0.1f;  // of the scene's diagonal
constexpr float kOffset = 1e-5f;  // of the scene's size: far above what any engine's rounding moves a hit by

/// Where rays of a set may start: a point just off a surface, and the normal on that side.
struct Start {
  Vec3 position, normal;
};

std::vector<Ray> primary_rays(const SceneDesc& desc, std::size_t count) {
  const int tiles = std::max(1, static_cast<int>(std::sqrt(double(count))) / kTile);
  Camera camera = render::choose_camera(desc, tiles * kTile, tiles * kTile);
  camera.lens_radius = 0;
  const render::Lens lens(camera, tiles * kTile, tiles * kTile);
  std::vector<Ray> rays;
  for (int tile = 0; tile < tiles * tiles; ++tile)
    for (int pixel = 0; pixel < kTile * kTile; ++pixel) {
      const int x = tile % tiles * kTile + pixel % kTile, y = tile / tiles * kTile + pixel / kTile;
      rays.push_back(lens.ray({float(x) + 0.5f, float(y) + 0.5f}, {}));
    }
  return rays;
}

std::vector<Start> hits_of(const Scene& scene, const std::vector<Ray>& rays, Executor& executor) {
  std::vector<Hit> hits(rays.size());
  scene.closest_hit(rays, hits, &executor);
  const Box3 bounds = scene.bounds();
  const float reach = max(max_component(abs(bounds.lower)), max_component(abs(bounds.upper)));
  const float offset = kOffset * max(length(bounds.extent()), reach);
  std::vector<Start> starts;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].is_hit()) continue;
    const Vec3 normal = dot(hits[i].normal, rays[i].direction) < 0 ? hits[i].normal : -hits[i].normal;
    starts.push_back({rays[i].at(hits[i].t) + normal * offset, normal});
  }
  return starts;
}

/// Cosine-distributed rays: one from each start, and again from the first until there are `count`, as a
/// renderer sends several through a pixel. None when there is no start.
std::vector<Ray> diffuse_rays(const std::vector<Start>& starts, std::size_t count, float t_max,
                              std::uint64_t seed) {
  std::vector<Ray> rays;
  if (starts.empty()) return rays;
  Random random(seed);
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Start& start = starts[i % starts.size()];
    Vec3 tangent, bitangent;
    orthonormal_basis(start.normal, tangent, bitangent);
    const float u = random.uniform(), v = random.uniform();
    const Vec3 local = render::cosine_hemisphere({u, v});
    const Vec3 direction = tangent * local.x + bitangent * local.y + start.normal * local.z;
    rays.push_back({start.position, 0, normalize(direction), t_max});
  }
  return rays;
}

std::vector<Ray> random_rays(const Box3& bounds, std::size_t count) {
  Random random(31);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = random.in_box(bounds.lower, bounds.upper);
    ray.direction = random.direction();
  }
  return rays;
}

/// Why no engine can be asked with this ray; empty when all can.
std::string obstacle(const Ray& ray) {
  if (!is_finite(ray.origin)) return "an origin that is not finite";
  if (!is_finite(ray.direction)) return "a direction that is not finite";
  const float largest = max_component(abs(ray.direction));
  if (!(largest >= 0x1p-96f && largest <= 0x1p96f))
    return fmt::format("a direction of size {:g}, expected 2^-96 to 2^96", largest);
  if (std::isnan(ray.t_min) || std::isnan(ray.t_max)) return "a t_min or t_max that is not a number";
  return "";
}

}  // namespace

std::vector<RaySet> make_ray_sets(const Scene& scene, const SceneDesc& desc, std::size_t count,
                                  const std::vector<std::string>& names, Executor& executor) {
  // Each set comes from the one before, so all are made, and those that were asked for are kept.
  const float diagonal = length(scene.bounds().extent());
  const std::vector<Ray> primary = primary_rays(desc, count);
  const std::vector<Start> first = hits_of(scene, primary, executor);
  const std::vector<Ray> occlusion = diffuse_rays(first, count, kOcclusionLength * diagonal, 11);
  const std::vector<Ray> bounce1 = diffuse_rays(first, count, kInfinity, 12);
  const std::vector<Ray> bounce2 = diffuse_rays(hits_of(scene, bounce1, executor), count, kInfinity, 13);

  std::vector<RaySet> sets{{"primary", Question::closest_hit, true, primary},
                           {"occlusion", Question::any_hit, false, occlusion},
                           {"bounce1", Question::closest_hit, false, bounce1},
                           {"bounce2", Question::closest_hit, false, bounce2},
                           {"random", Question::closest_hit, false, random_rays(scene.bounds(), count)}};
  std::erase_if(sets, [&](const RaySet& set) {
    return set.rays.empty() || std::find(names.begin(), names.end(), set.name) == names.end();
  });
  return sets;
}

RaySet read_rays(const std::string& path) {
  static_assert(sizeof(Ray) == 32 && std::endian::native == std::endian::little);
  const std::string bytes = io::read_file(path);
  if (bytes.size() % sizeof(Ray) != 0)
    throw FileError(path, "",
                    fmt::format("has {} bytes, expected a multiple of 32: records of eight little-endian "
                                "floats, origin x y z, t_min, direction x y z, t_max",
                                bytes.size()));
  const std::string name = std::filesystem::path(path).stem().string();
  if (std::find(std::begin(kRaySetNames), std::end(kRaySetNames), name) != std::end(kRaySetNames))
    throw FileError(path, "",
                    "would be mixed up with the set \"" + name + "\" of the bench, expected another name");
  RaySet set{name, Question::closest_hit, false, {}};
  set.rays.resize(bytes.size() / sizeof(Ray));
  std::memcpy(set.rays.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; i < set.rays.size(); ++i) {
    Ray& ray = set.rays[i];
    if (const std::string what = obstacle(ray); !what.empty())
      throw FileError(path, fmt::format("ray {}", i), "has " + what);
    // Below 0 counts as 0 here, and is not defined elsewhere.
    ray.t_min = max(ray.t_min, 0.0f);
  }
  return set;
}

}  // namespace boxwood::app
