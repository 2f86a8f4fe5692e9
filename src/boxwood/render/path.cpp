#include "boxwood/render/path.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "boxwood/render/bsdf.h"
#include "boxwood/render/draws.h"
#include "boxwood/render/light.h"
#include "boxwood/render/material.h"
#include "boxwood/render/plain_block.h"
#include "boxwood/render/shadow.h"
#include "boxwood/render/uv_frame.h"

namespace boxwood::render {
namespace {

// Bounds for light that is caught in glass, and for rays that pass through clear surfaces one behind the
// other; roulette ends other paths long before.
constexpr int kMaxBounces = 64, kMaxSteps = 1024;
/// How many hits ahead the corners of triangles are asked for; memory answers meanwhile.
constexpr std::size_t kAhead = 4;

/// So many groups of materials are kept apart where hits are sorted by them.
constexpr std::size_t kMaterialGroups = 256;

constexpr int kRouletteAfter = 3;  // bounces; early ones carry most of the picture
constexpr float kMaxSurvival = 0.95f;

/// How far a cone of rays opens, in radians, when a surface scatters it: textures seen by way of a wall need
/// no detail.
constexpr float kScatteredAngle = 0.2f;

/// The weight of a sample of density `a` when the same light could
/// have been found with density `b`: Veach's power heuristic.
float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

/// How many paths go on together: enough to keep the kernels full, few enough to stay in the nearer caches.
constexpr std::size_t kPaths = 2048;

/// What a path carries along beside its ray: one line of the cache.
struct alignas(64) Path {
  Path(Sampler own_sampler, std::uint32_t own_sample, float pixel_angle)
      : sampler(own_sampler), sample(own_sample), cone_angle(pixel_angle) {}

  Sampler sampler;
  std::uint32_t sample;  // whose light it gathers
  Vec3 throughput{1, 1, 1};
  Vec3 absorption{0, 0, 0};  // of what the ray is in
  float cone_width = 0, cone_angle;
  float pdf = 0;  // of the direction that it took last
  std::uint16_t bounce = 0, steps = 0;
  // Next-event estimation could not have found what this direction finds; true at the camera.
  bool is_perfect = true;
};
static_assert(sizeof(Path) == 64);

/// Has the processor fetch what is soon to be looked at.
void prefetch([[maybe_unused]] const Path& path) {
#if defined(__GNUC__)
  __builtin_prefetch(&path, 1);
#endif
}

/// Rays that are traced together, and whose they are.
struct Front {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> paths;

  std::size_t size() const { return paths.size(); }
  void add(const Ray& ray, std::uint32_t path) {
    rays.push_back(ray);
    paths.push_back(path);
  }
  void clear() {
    rays.clear();
    paths.clear();
  }
};

/// Light that a sample gets if nothing is in the way.
struct Pending {
  std::uint32_t sample;
  Vec3 light;
};

/// The hits of a block on their way through a step: where light may come from, and go on to.
struct Step {
  int count = 0, plain_count = 0;
  std::array<std::uint32_t, kBlock> paths;  // positions among the paths
  std::array<Surface, kBlock> surfaces;
  std::array<const Material*, kBlock> materials;
  std::array<bool, kBlock> is_plain;
  PlainBlock plain;  // how plain surfaces scatter light, and all others:
  std::array<Look, kBlock> looks;
  std::array<std::optional<Bsdf>, kBlock> bsdfs;
  Receivers places;
  Leaving leaving;
  Draws draws;
  Floats light_choices{}, lobe_choices{};
  Vec2s light_points, directions;
  LightSamples lights;

  bool has_spread(int i) const { return is_plain[i] || bsdfs[i]->has_spread(); }
};

class PathTracer final : public Integrator {
 public:
  PathTracer(const Scene& scene, const Camera& camera, float pixel_angle)
      : scene_(scene), lights_(scene, camera), shadows_(scene), pixel_angle_(pixel_angle) {
    const SceneDesc& desc = scene.description();
    for (const Material& material : desc.materials) materials_.emplace_back(material);
    for (const Instance& instance : placed_instances(desc)) {
      const MaterialId own = desc.geometries[instance.geometry.value].material;
      const MaterialId id = instance.material.is_valid() ? instance.material : own;
      group_of_instance_.push_back(
          id.is_valid() ? static_cast<std::uint8_t>(1 + id.value % (kMaterialGroups - 1)) : 0);
    }
  }

  int channels() const override { return 3; }

  bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, RayCounts& rays) const override {
    bool is_counted = false;
    sample_many({&ray, 1}, {&sampler, 1}, out, {&is_counted, 1}, rays);
    return is_counted;
  }

  void sample_many(std::span<const Ray> camera_rays, std::span<Sampler> samplers, std::span<float> out,
                   std::span<bool> is_counted, RayCounts& rays) const override {
    std::fill(out.begin(), out.end(), 0.0f);
    std::fill(is_counted.begin(), is_counted.end(), true);
    Batch batch(std::min(camera_rays.size(), kPaths), out);
    for (std::size_t started = 0;;) {
      // New paths take the places of those that have come to their end: batches stay full.
      const std::size_t old_count = batch.front.size();
      for (; started < camera_rays.size() && !batch.vacant.empty(); ++started) {
        const std::uint32_t place = batch.vacant.back();
        batch.vacant.pop_back();
        batch.paths[place] = Path(samplers[started], static_cast<std::uint32_t>(started), pixel_angle_);
        batch.front.add(camera_rays[started], place);
      }
      const std::size_t count = batch.front.size();
      if (count == 0) break;

      // Find what each path hits. Rays of the camera go the same way, so they go apart from the others.
      const std::span<const Ray> front_rays = batch.front.rays;
      const std::span hits = std::span(batch.hits).first(count);
      scene_.closest_hit(front_rays.first(old_count), hits.first(old_count), &serial_executor());
      scene_.closest_hit(front_rays.subspan(old_count), hits.subspan(old_count), &serial_executor());
      rays.bounce += old_count;
      rays.camera += count - old_count;

      // Let each go on from there, material by material.
      batch.next.clear();
      batch.pending.clear();
      batch.ways.clear();
      sort_by_material(batch, count);
      for (std::size_t k = 0; k < count; ++k) {
        if (k + 2 * kAhead < count) prefetch_triangle(scene_, hits[batch.order[k + 2 * kAhead]]);
        if (k + kAhead < count) {
          const std::uint32_t ahead = batch.order[k + kAhead];
          prefetch_corners(scene_, hits[ahead]);
          prefetch(batch.paths[batch.front.paths[ahead]]);
        }
        arrive(batch, batch.order[k]);
        if (batch.step.count == kBlock || k + 1 == count) leave(batch);
      }

      // Find how much of the lights that they asked for is in sight.
      batch.transmittances.resize(batch.ways.size());
      shadows_.transmittances(batch.ways, batch.transmittances, rays);
      for (std::size_t i = 0; i < batch.pending.size(); ++i)
        batch.gather(batch.pending[i].sample, batch.pending[i].light * batch.transmittances[i]);
      std::swap(batch.front, batch.next);
    }
  }

 private:
  /// The memory of paths that go on together.
  struct Batch {
    Batch(std::size_t size, std::span<float> gathered)
        : paths(size, Path({0, 0}, 0, 0)), left_from(size), vacant(size), hits(size), order(size), out(gathered) {
      std::iota(vacant.rbegin(), vacant.rend(), 0u);
      pending.reserve(size);
    }
    void gather(std::uint32_t sample, Vec3 light) {
      float* sum = &out[3 * std::size_t(sample)];
      sum[0] += light.x;
      sum[1] += light.y;
      sum[2] += light.z;
    }

    std::vector<Path> paths;            // each stays in its place
    std::vector<Receiver> left_from;    // the last point of each
    std::vector<std::uint32_t> vacant;  // places that no path has
    Front front, next;                  // the rays of this step, and of the one after it
    std::vector<Hit> hits;              // what the rays hit,
    std::vector<std::uint32_t> order;   // and in which order hits are looked at
    std::vector<Pending> pending;       // one for each ray towards a light,
    std::vector<Shadows::Way> ways;     // and what it starts in
    std::vector<Vec3> transmittances;
    std::span<float> out;  // the light of each sample
    Step step;
  };

  /// Puts the first `count` hits in an order in which equal materials follow each other: the processor then
  /// foresees branches better. Instances stand for their materials; misses come first.
  void sort_by_material(Batch& batch, std::size_t count) const {
    std::array<std::uint32_t, kMaterialGroups + 1> first{};
    for (std::size_t i = 0; i < count; ++i) ++first[group_of(batch.hits[i]) + 1];
    for (std::size_t group = 1; group < first.size(); ++group) first[group] += first[group - 1];
    for (std::size_t i = 0; i < count; ++i)
      batch.order[first[group_of(batch.hits[i])]++] = static_cast<std::uint32_t>(i);
  }

  std::size_t group_of(const Hit& hit) const { return hit ? group_of_instance_[hit.instance_id.value] : 0; }

  /// Takes a path to what its ray hit: it goes straight on from there, or becomes part of the step, or has
  /// come to its end.
  void arrive(Batch& batch, std::uint32_t position) const {
    const Ray& ray = batch.front.rays[position];
    const Hit& hit = batch.hits[position];
    const std::uint32_t place = batch.front.paths[position];
    Path& path = batch.paths[place];
    Step& step = batch.step;
    if (max_component(path.absorption) > 0)
      path.throughput *= beer(path.absorption, hit ? hit.t * length(ray.direction) : kInfinity);
    if (!hit) {
      batch.gather(path.sample, path.throughput * background(ray.direction, path, batch.left_from[place]));
      return finish(batch, place);
    }
    const SceneDesc& desc = scene_.description();
    const int point = step.count;
    Surface& surface = step.surfaces[point];
    surface = surface_at(scene_, ray, hit);
    path.cone_width += path.cone_angle * hit.t;

    MaterialId id = surface.material;
    const PreparedMaterial* prepared = &this->prepared(id);
    if (prepared->is_emissive) gather_emission(batch, place, ray.direction, hit, surface);
    if (path.bounce == kMaxBounces || ++path.steps == kMaxSteps) return finish(batch, place);

    // Which material it is, where it is several; and whether the light meets it at all.
    if (prepared->is_mix) {
      id = choose_material(desc, id, surface.uv, path.sampler.next_1d());
      prepared = &this->prepared(id);
    }
    const Material& material = material_of(desc, id);
    if (prepared->is_see_through) {
      const float opacity = opacity_at(desc, material, surface.uv);
      if (opacity < 1 && (opacity <= 0 || !(path.sampler.next_1d() < opacity))) {
        enter(path, material, surface, ray.direction);
        return batch.next.add(surface.spawn(ray.direction), place);
      }
    }

    // What scatters light there, and to which sides.
    const float uv_width = prepared->has_color_texture ? path.cone_width * uv_density(scene_, hit) : 0.0f;
    const Vec3 normal =
        prepared->has_normal_texture ? mapped_normal(scene_, hit, surface, material) : surface.shading_normal;
    const Vec3 outgoing = -ray.direction;
    const Vec3 color = prepared->is_plain ? base_color(desc, material, surface.uv, uv_width) : Vec3{0, 0, 0};
    // (A black base has no lobe.)
    step.is_plain[point] = max_component(color) > 0;
    if (step.is_plain[point]) {
      step.plain.set(point, *prepared, color, surface, normal, outgoing);
      step.places.normal.set(point, dot(surface.normal, outgoing) < 0 ? -surface.normal : surface.normal);
      ++step.plain_count;
    } else {
      step.looks[point] = look_at(desc, material, *prepared, surface.uv, uv_width);
      const Bsdf& bsdf = step.bsdfs[point].emplace(step.looks[point], surface, normal, outgoing);
      step.places.normal.set(point, bsdf.spreads_behind() ? Vec3{0, 0, 0} : bsdf.facing_normal());
    }
    step.paths[point] = place;
    step.materials[point] = &material;
    step.places.position.set(point, surface.position);
    step.leaving.position.set(point, surface.position);
    step.leaving.normal.set(point, surface.normal);
    step.leaving.clearance[point] = surface.clearance();
    step.draws.set(point, path.sampler);
    ++step.count;
  }

  /// Lets all paths of the step ask for light and go on. Leaves it empty.
  void leave(Batch& batch) const {
    Step& step = batch.step;
    const int count = std::exchange(step.count, 0);
    if (count == 0) return;

    // The first draw chooses a light and a lobe; a second goes to a point of the light, where one is asked
    // for.
    step.draws.draw();
    for (int i = 0; i < count; ++i) {
      const Vec2 choices = step.draws.pair(i, 0);
      step.light_choices[i] = choices.x;
      step.lobe_choices[i] = choices.y;
      step.light_points.set(i, step.draws.pair(i, 1));
      step.directions.set(i, step.draws.pair(i, step.has_spread(i) ? 2 : 1));
    }
    lights_.sample(std::span(step.surfaces).first(static_cast<std::size_t>(count)), step.places, step.leaving,
                   step.light_choices, step.light_points, step.lights);
    if (std::exchange(step.plain_count, 0) > 0)
      step.plain.scatter(step.lights.direction, step.lobe_choices, step.directions);

    for (int i = 0; i < count; ++i) {
      if (step.has_spread(i) && step.lights.pdf[i] > 0) ask_for_light(batch, i);
      if (!go_on(batch, i)) finish(batch, step.paths[i]);
    }
  }

  /// Goes on in a direction that the surface chooses. False at the path's end.
  static bool go_on(Batch& batch, int i) {
    const Step& step = batch.step;
    Path& path = batch.paths[step.paths[i]];
    const Surface& surface = step.surfaces[i];
    const std::optional<BsdfSample> next =
        step.is_plain[i] ? step.plain.next(i)
                         : step.bsdfs[i]->sample(step.lobe_choices[i], step.directions[i]);
    if (!next) return false;
    path.throughput *= next->weight;

    // Russian roulette: end paths that carry little, and let the others stand for them.
    int drawn = step.has_spread(i) ? 3 : 2;
    if (path.bounce >= kRouletteAfter) {
      const float survival = min(max_component(path.throughput), kMaxSurvival);
      if (!(step.draws.pair(i, drawn++).x < survival)) return false;
      path.throughput *= 1 / survival;
    }
    path.sampler.skip(static_cast<std::uint32_t>(drawn));
    if (!(max_component(path.throughput) > 0)) return false;
    if (next->is_transmission) enter(path, *step.materials[i], surface, next->direction);
    batch.left_from[step.paths[i]] = {step.places.position[i], step.places.normal[i]};
    path.pdf = next->pdf;
    path.is_perfect = next->is_perfect;
    if (!next->is_perfect) path.cone_angle = max(path.cone_angle, kScatteredAngle);
    ++path.bounce;
    batch.next.add(surface.spawn(next->direction), step.paths[i]);
    return true;
  }

  static void finish(Batch& batch, std::uint32_t place) { batch.vacant.push_back(place); }

  /// Adds the light that the surface sends out itself, in so far as it is this way's to find.
  void gather_emission(Batch& batch, std::uint32_t place, Vec3 direction, const Hit& hit,
                       const Surface& surface) const {
    const Path& path = batch.paths[place];
    const Vec3 emission = lights_.emission(surface, direction);
    if (!(max_component(emission) > 0)) return;
    float weight = 1;
    if (!path.is_perfect)
      weight = power_heuristic(path.pdf, lights_.pdf(hit, surface, direction, batch.left_from[place]));
    batch.gather(path.sample, path.throughput * emission * weight);
  }

  /// Remembers what the path is in, on the other side of a surface.
  static void enter(Path& path, const Material& material, const Surface& surface, Vec3 direction) {
    if (material.is_thin) return;
    path.absorption = dot(direction, surface.normal) < 0 ? material.absorption : material.outer_absorption;
  }

  Vec3 background(Vec3 direction, const Path& path, const Receiver& from) const {
    Vec3 sum = lights_.dome(direction);
    lights_.for_each_far_light(direction, from, [&](const Lights::FarLight& light) {
      sum += light.radiance * (path.is_perfect ? 1 : power_heuristic(path.pdf, light.pdf));
    });
    return sum;
  }

  /// Asks how much of the light that was tried is in sight.
  static void ask_for_light(Batch& batch, int i) {
    const Step& step = batch.step;
    const Path& path = batch.paths[step.paths[i]];
    const LightSamples& lights = step.lights;
    const BsdfValue toward =
        step.is_plain[i] ? step.plain.toward_light(i) : step.bsdfs[i]->evaluate(lights.direction[i]);
    if (!(max_component(toward.value) > 0)) return;
    const float weight = lights.is_perfect[i] != 0 ? 1 : power_heuristic(lights.pdf[i], toward.pdf);
    batch.ways.push_back({lights.shadow_ray(i), path.absorption});
    batch.pending.push_back(
        {path.sample, path.throughput * toward.value * lights.radiance[i] * (weight / lights.pdf[i])});
  }

  const PreparedMaterial& prepared(MaterialId id) const {
    return id.is_valid() ? materials_[id.value] : default_material_;
  }

  const Scene& scene_;
  Lights lights_;
  Shadows shadows_;
  float pixel_angle_;
  std::vector<PreparedMaterial> materials_;
  std::vector<std::uint8_t> group_of_instance_;
  PreparedMaterial default_material_{Material{}};
};

}  // namespace

std::unique_ptr<Integrator> make_path_tracer(const Scene& scene, const Camera& camera, float pixel_angle) {
  return std::make_unique<PathTracer>(scene, camera, pixel_angle);
}

}  // namespace boxwood::render
