// instances_bench: how fast are scenes of many moved copies, beside Embree's instances?
//
//     boxwood_instances [FILE] [--rays N] [--rounds N] [--counts 1,16,400,10000]
//                       [--sets primary,occlusion,bounce1,random]
//
// One thread; the mesh of FILE, or a bumpy sphere, turned and scaled, many times. Our single rays, our batch
// and Embree's single rays (quality MEDIUM, denormals flushed) take turns, the median of the rounds counts,
// and the numbers of hits and the sums of t must agree before a rate is printed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "bench_rays.h"
#include "boxwood/core/random.h"
#include "boxwood/io/load.h"
#include "boxwood/scene/scene.h"
#include "embree_settings.h"

namespace boxwood::bench {
namespace {

TriangleMesh bumpy_sphere() {
  constexpr std::uint32_t kRows = 128, kColumns = 256;
  TriangleMesh mesh;
  for (std::uint32_t row = 0; row <= kRows; ++row)
    for (std::uint32_t column = 0; column <= kColumns; ++column) {
      const float a = 3.14159265f * float(row) / kRows, b = 6.2831853f * float(column % kColumns) / kColumns;
      const float r = 1 + 0.05f * std::sin(9 * a) * std::sin(8 * b);
      mesh.positions.push_back(Vec3{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)} * r);
    }
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::uint32_t i = row * (kColumns + 1) + column, j = i + kColumns + 1;
      mesh.indices.push_back({i, j, i + 1});
      mesh.indices.push_back({i + 1, j, j + 1});
    }
  return mesh;
}

/// The largest mesh of a file.
TriangleMesh mesh_of(const std::string& path) {
  SceneDesc desc = io::load(path);
  TriangleMesh* largest = nullptr;
  for (Geometry& geometry : desc.geometries)
    if (auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes))
      if (!largest || mesh->indices.size() > largest->indices.size()) largest = mesh;
  if (!largest) throw std::invalid_argument(path + " has no triangles");
  return std::move(*largest);
}

/// Copies on a square lattice, turned about any axis, half to one and a half times as large; neighbours may
/// overlap.
std::vector<Affine3> places(const TriangleMesh& mesh, std::size_t count) {
  Box3 box;
  for (const Vec3 p : mesh.positions) box.extend(p);
  const float size = length(box.extent());
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(double(count))));
  Random random(9);
  std::vector<Affine3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = Vec3{float(i % side), random.uniform() * 0.5f, float(i / side)} * (0.8f * size);
    out.push_back(Affine3::translation(at) * Affine3::rotation(random.direction(), 360 * random.uniform()) *
                  Affine3::scale(0.5f + random.uniform()) * Affine3::translation(-box.center()));
  }
  return out;
}

class EmbreeInstances {
 public:
  EmbreeInstances(const TriangleMesh& mesh, const std::vector<Affine3>& placed)
      : device_(rtcNewDevice(app::embree_config())), object_(new_scene()), scene_(new_scene()) {
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                               0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               sizeof(mesh.indices[0]), mesh.indices.size());
    attach(object_, triangles);
    rtcCommitScene(object_);
    for (const Affine3& world_from_object : placed) {
      RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, object_);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &world_from_object);
      attach(scene_, instance);
    }
    rtcCommitScene(scene_);
  }
  ~EmbreeInstances() {
    rtcReleaseScene(scene_);
    rtcReleaseScene(object_);
    rtcReleaseDevice(device_);
  }
  EmbreeInstances(const EmbreeInstances&) = delete;
  EmbreeInstances& operator=(const EmbreeInstances&) = delete;

  RTCScene scene() const { return scene_; }

 private:
  RTCScene new_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
  }
  static void attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene object_, scene_;
};

struct Rate {
  std::vector<double> seconds;
  app::Answers answers;
  double median() {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }
};

/// Seconds that `work` takes.
double timed(const std::function<void()>& work) {
  const double begin = app::seconds_now();
  work();
  return app::seconds_now() - begin;
}

void measure(const Scene& scene, const EmbreeInstances& embree, const app::RaySet& set, int rounds,
             const std::string& label) {
  const std::vector<Ray>& rays = set.rays;
  const bool is_any = set.question == app::Question::any_hit;
  Rate single, batch, peer;
  std::vector<Hit> hits(rays.size());
  const std::unique_ptr<bool[]> is_hidden(new bool[rays.size()]);
  const auto answers = [&] {
    app::Answers out;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (is_any ? is_hidden[i] : hits[i].is_hit()) out.add_hit(is_any ? 1 : hits[i].t);
    }
    return out;
  };
  for (int round = 0; round < rounds; ++round) {
    single.seconds.push_back(timed([&] {
      for (std::size_t i = 0; i < rays.size(); ++i)
        if (is_any)
          is_hidden[i] = scene.any_hit(rays[i]);
        else
          hits[i] = scene.closest_hit(rays[i]);
    }));
    single.answers = answers();
    batch.seconds.push_back(timed([&] {
      if (is_any)
        scene.any_hit(rays, {is_hidden.get(), rays.size()}, &serial_executor());
      else
        scene.closest_hit(rays, hits, &serial_executor());
    }));
    batch.answers = answers();

    std::vector<RTCRayHit> queries(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& r = rays[i];
      queries[i].ray = {r.origin.x,    r.origin.y,    r.origin.z, r.t_min, r.direction.x,
                        r.direction.y, r.direction.z, 0,          r.t_max, ~0u};
      queries[i].hit.geomID = queries[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    peer.seconds.push_back(timed([&] {
      const app::DenormalsAreZero mode;
      for (RTCRayHit& query : queries)
        if (is_any)
          rtcOccluded1(embree.scene(), &context, &query.ray);
        else
          rtcIntersect1(embree.scene(), &context, &query);
    }));
    peer.answers = {};
    for (const RTCRayHit& query : queries)
      if (is_any ? query.ray.tfar < 0 : query.hit.geomID != RTC_INVALID_GEOMETRY_ID)
        peer.answers.add_hit(is_any ? 1 : query.ray.tfar);
  }

  if (!(single.answers == batch.answers)) throw std::runtime_error(label + ": batch and single rays differ");
  const double most = double(std::max(single.answers.hits, peer.answers.hits)) + 1;
  if (std::abs(double(single.answers.hits) - double(peer.answers.hits)) > 1e-3 * most ||
      std::abs(single.answers.checksum - peer.answers.checksum) >
          1e-3 * std::max(single.answers.checksum, peer.answers.checksum))
    throw std::runtime_error(label + ": Embree and we differ");
  const double count = double(rays.size()) * 1e-6, ours = single.median(), ours_batch = batch.median(),
               theirs = peer.median();
  std::printf("| %s | %s | %.2f (%.2f) | %.2f (%.2f) | %.2f | %.0f%% |\n", label.c_str(), set.name.c_str(),
              count / ours, theirs / ours, count / ours_batch, theirs / ours_batch, count / theirs,
              100 * double(single.answers.hits) / double(rays.size()));
  std::fflush(stdout);
}

void run(int argc, char** argv) {
  std::string file, counts = "1,16,400,10000", sets = "primary,occlusion,bounce1,random";
  std::size_t ray_count = 1 << 16;
  int rounds = 5;
  const auto split = [](const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) out.push_back(word);
    return out;
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word[0] != '-') {
      file = word;
      continue;
    }
    if (++i == argc) throw std::invalid_argument(word + " wants a value");
    if (word == "--rays")
      ray_count = std::stoul(argv[i]);
    else if (word == "--rounds")
      rounds = std::stoi(argv[i]);
    else if (word == "--counts")
      counts = argv[i];
    else if (word == "--sets")
      sets = argv[i];
    else
      throw std::invalid_argument("no option " + word);
  }
  const TriangleMesh mesh = file.empty() ? bumpy_sphere() : mesh_of(file);
  std::printf(
      "| copies | rays | single (over Embree) | batch (over Embree) | Embree single | hits |\n"
      "|---|---|---|---|---|---|\n");
  for (const std::string& count : split(counts)) {
    const std::vector<Affine3> placed = places(mesh, std::stoul(count));
    SceneDesc desc;
    const GeometryId id = desc.add(mesh);
    for (const Affine3& place : placed) desc.add(Instance{id, place, {}});
    const Scene scene(desc);
    const EmbreeInstances embree(mesh, placed);
    for (const app::RaySet& set : app::make_ray_sets(scene, desc, ray_count, split(sets), serial_executor()))
      measure(scene, embree, set, rounds, count);
  }
}

}  // namespace
}  // namespace boxwood::bench

int main(int argc, char** argv) {
  try {
    boxwood::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "boxwood_instances: %s\n", error.what());
    return 1;
  }
}
