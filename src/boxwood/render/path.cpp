#include "boxwood/render/path.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "boxwood/render/bsdf.h"
#include "boxwood/render/draws.h"
#include "boxwood/render/light.h"
#include "boxwood/render/material.h"
#include "boxwood/render/next_rays.h"
#include "boxwood/render/path_batch.h"
#include "boxwood/render/plain_block.h"
#include "boxwood/render/shadow.h"
#include "boxwood/render/uv_frame.h"

namespace boxwood::render {
namespace {

/// A bound for rays that pass through clear surfaces one behind the other.
constexpr int kMaxSteps = 1024;
/// Hits are sorted by so many groups: 0 hit nothing, the others are materials.
constexpr std::size_t kMiss = 0, kGroups = 256;

constexpr int kRouletteAfter = 3;  // bounces; early ones carry most of the picture

/// How far a cone of rays opens, in radians, when a surface scatters it: textures seen by way of a wall need
/// no detail.
constexpr float kScatteredAngle = 0.2f;

/// How many paths go on together: enough to keep the kernels full, few enough to stay in the nearer caches.
constexpr std::size_t kPaths = 2048;

/// Some points of a block.
class PointList {
 public:
  /// Puts `i` at the end, without a branch.
  void add_if(int i, bool is_in) {
    points_[size_] = static_cast<std::uint8_t>(i);
    size_ += is_in;
  }
  const std::uint8_t* begin() const { return points_.data(); }
  const std::uint8_t* end() const { return points_.data() + size_; }

 private:
  std::array<std::uint8_t, kBlock> points_;
  std::size_t size_ = 0;
};

/// Hits of a block on their way through a step: where light may come from, and go on to.
struct Step {
  /// What scatters light at a point; nothing where the path ended or went straight on.
  enum class Kind : std::uint8_t { none, plain, other };

  std::array<Kind, kBlock> kinds;
  std::array<std::uint32_t, kBlock> places;  // of the paths
  SurfaceBlock surfaces;
  std::array<const Material*, kBlock> materials;
  PlainBlock plain;  // how plain surfaces scatter light, and all others:
  std::array<Look, kBlock> looks;
  std::array<std::optional<Bsdf>, kBlock> bsdfs;
  Receivers receivers;
  PathPoints paths;
  Draws draws;
  Floats light_choices{}, lobe_choices{};
  Vec2s light_points, directions;
  LightSamples lights;
  Integers may_meet_veil{}, is_in_medium{};
  Scattered scattered;
  NextRays next;

  /// How many numbers a path draws at a point, before that of the roulette.
  int draw_count(int i) const { return paths.is_spread[i] != 0 ? 3 : 2; }
};

class PathTracer final : public Integrator {
 public:
  PathTracer(const Scene& scene, const Camera& camera, float pixel_angle, int bounces)
      : scene_(scene),
        surfaces_(scene),
        lights_(scene, camera),
        shadows_(scene),
        pixel_angle_(pixel_angle),
        bounces_(bounces) {
    const SceneDesc& desc = scene.description();
    for (const Material& material : desc.materials) materials_.emplace_back(material);
    for (const Instance& instance : placed_instances(desc)) {
      const MaterialId own = desc.geometries[instance.geometry.value].material;
      const MaterialId id = instance.material.is_valid() ? instance.material : own;
      group_of_instance_.push_back(
          static_cast<std::uint8_t>(1 + (id.is_valid() ? id.value % (kGroups - 1) : 0)));
    }
  }

  int channels() const override { return 3; }

  bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, RayCounts& rays) const override {
    bool is_counted = false;
    sample_many({&ray, 1}, {&sampler, 1}, out, {&is_counted, 1}, {&rays, 1});
    return is_counted;
  }

  void sample_many(std::span<const Ray> camera_rays, std::span<Sampler> samplers, std::span<float> out,
                   std::span<bool> is_counted, std::span<RayCounts> rays) const override {
    std::fill(out.begin(), out.end(), 0.0f);
    std::fill(is_counted.begin(), is_counted.end(), true);
    Work work(std::min(camera_rays.size(), kPaths), out, rays);
    PathBatch& batch = work.batch;
    for (std::size_t started = 0;;) {
      // New paths take the places of those that have come to their end: batches stay full.
      const std::size_t old_count = batch.front.size();
      for (; started < camera_rays.size() && !batch.is_full(); ++started) {
        batch.start(Path(samplers[started], static_cast<std::uint32_t>(started), pixel_angle_),
                    camera_rays[started]);
        ++rays[started].camera;
      }
      const std::size_t count = batch.front.size();
      if (count == 0) break;

      // Find what each path hits. Rays of the camera go the same way, so they go apart from the others.
      const std::span<const Ray> front_rays = batch.front.rays();
      const std::span hits = std::span(batch.hits).first(count);
      scene_.closest_hit(front_rays.first(old_count), hits.first(old_count), &serial_executor());
      scene_.closest_hit(front_rays.subspan(old_count), hits.subspan(old_count), &serial_executor());

      // Let each go on from there, material by material.
      batch.next.clear();
      work.light.clear();
      const std::size_t misses = sort_by_material(hits, work.order);
      for (std::size_t k = 0; k < misses; ++k) escape(work, work.order[k]);
      for (std::size_t k = misses; k < count; k += kBlock)
        scatter(work, std::span(work.order).subspan(k, std::min<std::size_t>(kBlock, count - k)),
                std::span(work.order).first(count).subspan(std::min<std::size_t>(k + kBlock, count)));

      // Find how much of the lights that they asked for is in sight.
      shadows_.deliver(work.light, out, rays);
      std::swap(batch.front, batch.next);
    }
  }

 private:
  /// The memory of one call.
  struct Work {
    Work(std::size_t size, std::span<float> samples, std::span<RayCounts> counts)
        : batch(size), order(size), light(size), out(samples), rays(counts) {}
    void gather(std::uint32_t sample, Vec3 light) {
      float* sum = &out[3 * std::size_t(sample)];
      sum[0] += light.x;
      sum[1] += light.y;
      sum[2] += light.z;
    }

    /// A path ends; its first ray came from the camera.
    void end(std::uint32_t place) {
      const Path& path = batch[place];
      rays[path.sample].bounce += path.steps - 1u;
      batch.end(place);
    }

    PathBatch batch;
    std::vector<std::uint32_t> order;  // in which hits are looked at
    Step step;
    AwaitedLight light;
    std::span<float> out;       // three floats for each sample
    std::span<RayCounts> rays;  // of each
  };

  /// Puts hits in an order in which equal materials follow each other: the processor then foresees branches
  /// better. Instances stand for their materials. Misses come first; returns how many. Has the processor
  /// fetch the triangles that were hit, on the way.
  std::size_t sort_by_material(std::span<const Hit> hits, std::span<std::uint32_t> order) const {
    std::array<std::uint32_t, kGroups + 1> first{};
    for (const Hit& hit : hits) ++first[group_of(hit) + 1];
    for (std::size_t group = 1; group < first.size(); ++group) first[group] += first[group - 1];
    const std::size_t misses = first[kMiss + 1];
    for (std::uint32_t i = 0; const Hit& hit : hits) {
      surfaces_.prefetch_triangle(hit);
      order[first[group_of(hit)]++] = i++;
    }
    return misses;
  }

  std::size_t group_of(const Hit& hit) const {
    return hit ? group_of_instance_[hit.instance_id.value] : kMiss;
  }

  /// A path leaves the scene.
  void escape(Work& work, std::uint32_t position) const {
    const std::uint32_t place = work.batch.front.place(position);
    Path& path = work.batch[place];
    ++path.steps;
    const Vec3 direction = work.batch.front.rays()[position].direction;
    if (max_component(path.absorption) > 0) path.throughput *= beer(path.absorption, kInfinity);
    work.gather(path.sample, path.throughput * background(direction, path, work.batch.left_from(place)));
    work.end(place);
  }

  /// Up to a block of paths look at what they hit, ask for light, and go on. Those `ahead` come next.
  void scatter(Work& work, std::span<const std::uint32_t> positions,
               std::span<const std::uint32_t> ahead) const {
    PathBatch& batch = work.batch;
    Step& step = work.step;
    const int count = static_cast<int>(positions.size());
    surfaces_.read(batch.front.rays(), batch.hits, positions, step.surfaces);
    bool is_any_plain = false;
    for (int i = 0; i < count; ++i) {
      // The block that comes next, meanwhile, is fetched.
      if (const auto k = static_cast<std::size_t>(i); k < ahead.size()) {
        surfaces_.prefetch_corners(batch.hits[ahead[k]]);
        batch.prefetch(batch.front.place(ahead[k]));
      }
      step.kinds[i] = arrive(work, positions[i], i);
      is_any_plain |= step.kinds[i] == Step::Kind::plain;
    }

    // The first draw chooses a light and a lobe; a second goes to a point of the light, where one is asked
    // for.
    step.draws.draw();
    for (int i = 0; i < count; ++i) {
      const Vec2 choices = step.draws.pair(i, 0);
      step.light_choices[i] = choices.x;
      step.lobe_choices[i] = choices.y;
      step.light_points.set(i, step.draws.pair(i, 1));
      step.directions.set(i, step.draws.pair(i, step.draw_count(i) - 1));
      step.paths.chance[i] = step.draws.pair(i, step.draw_count(i)).x;
    }
    step.receivers.position = step.surfaces.position;
    lights_.sample(step.surfaces, count, step.receivers, step.light_choices, step.light_points, step.lights);
    if (is_any_plain)
      step.plain.scatter(step.lights.direction, step.lobe_choices, step.directions, step.scattered);
    for (int i = 0; i < count; ++i) {
      if (step.kinds[i] != Step::Kind::other) continue;
      const Bsdf& bsdf = *step.bsdfs[i];
      if (step.paths.is_spread[i] != 0 && step.lights.pdf[i] > 0)
        step.scattered.set_toward_light(i, bsdf.evaluate(step.lights.direction[i]));
      step.scattered.set_next(i, bsdf.sample(step.lobe_choices[i], step.directions[i]));
    }
    shadows_.find_veiled(step.lights.shadow_rays, step.may_meet_veil);
    send_rays(step.paths, step.surfaces, step.scattered, step.lights, step.next);

    // Send them out, one kind after the other: lists leave no branches to foresee.
    PointList light, careful_light, onward, ending;
    for (int i = 0; i < count; ++i) {
      const bool is_live = step.kinds[i] != Step::Kind::none, asks = step.next.asks_for_light[i] != 0;
      const bool is_careful = (step.may_meet_veil[i] | step.is_in_medium[i]) != 0;
      light.add_if(i, is_live & asks & !is_careful);
      careful_light.add_if(i, is_live & asks & is_careful);
      onward.add_if(i, is_live & (step.next.goes_on[i] != 0));
      ending.add_if(i, is_live & (step.next.goes_on[i] == 0));
    }
    for (const int i : light)
      work.light.add(batch[step.places[i]].sample, step.next.light[i], step.lights.shadow_rays[i]);
    for (const int i : careful_light) {
      const Path& path = batch[step.places[i]];
      work.light.add_careful(path.sample, step.next.light[i], step.lights.shadow_rays[i], path.absorption);
    }
    for (const int i : onward) go_on(batch, step, i);
    for (const int i : ending) work.end(step.places[i]);
  }

  /// Takes a path to what its ray hit, point `i` of the step.
  Step::Kind arrive(Work& work, std::uint32_t position, int i) const {
    using Kind = Step::Kind;
    const Ray& ray = work.batch.front.rays()[position];
    const Hit& hit = work.batch.hits[position];
    const std::uint32_t place = work.batch.front.place(position);
    Path& path = work.batch[place];
    Step& step = work.step;
    const SceneDesc& desc = scene_.description();
    if (max_component(path.absorption) > 0)
      path.throughput *= beer(path.absorption, hit.t * length(ray.direction));
    path.cone_width += path.cone_angle * hit.t;

    MaterialId id = step.surfaces.material[i];
    TexturePoint point{step.surfaces.uv[i], step.surfaces.second_uv[i]};
    point.color = surfaces_.vertex_color(hit);
    const PreparedMaterial* prepared = &this->prepared(id);
    if (prepared->is_emissive) gather_emission(work, place, ray.direction, hit, step.surfaces[i]);
    ++path.steps;
    if (path.bounce == bounces_ || path.steps == kMaxSteps) {
      work.end(place);
      return Kind::none;
    }

    // Which material it is, where it is several; and whether the light meets it at all.
    if (prepared->is_mix) {
      id = choose_material(desc, id, point, path.sampler.next_1d());
      prepared = &this->prepared(id);
    }
    const Material& material = material_of(desc, id);
    if (prepared->is_see_through) {
      const float opacity = opacity_at(desc, material, point);
      if (opacity < 1 && (opacity <= 0 || !(path.sampler.next_1d() < opacity))) {
        const Surface surface = step.surfaces[i];
        enter(path, material, surface.normal, ray.direction);
        work.batch.next.add(surface.spawn(ray.direction), place);
        return Kind::none;
      }
    }

    // What scatters light there, and to which sides.
    step.places[i] = place;
    step.materials[i] = &material;
    step.draws.set(i, path.sampler);
    step.paths.throughput.set(i, path.throughput);
    step.is_in_medium[i] = max_component(path.absorption) > 0;
    step.paths.in_roulette[i] = path.bounce >= kRouletteAfter;
    if (prepared->has_color_texture) {
      point.width = path.cone_width * step.surfaces.uv_density[i];
      point.second_width = path.cone_width * step.surfaces.second_uv_density[i];
    }
    const auto bumped = [&](Vec3 normal) {
      return prepared->has_bumps
                 ? bumped_normal(scene_, hit, step.surfaces[i], normal, material.bump, material.bump_texture)
                 : normal;
    };
    const Vec3 normal =
        bumped(prepared->has_normal_texture ? mapped_normal(scene_, hit, step.surfaces[i],
                                                            material.normal_texture, material.normal_scale)
                                            : step.surfaces.shading_normal[i]);
    const Vec3 outgoing = -ray.direction;
    const Vec3 color = !prepared->is_plain           ? Vec3{0, 0, 0}
                       : prepared->has_color_texture ? base_color(desc, material, point)
                                                     : prepared->color;
    // (A black base has no lobe.)
    if (max_component(color) > 0) {
      const Vec3 geometric = step.surfaces.normal[i];
      step.plain.set(i, *prepared, color, geometric, normal, outgoing);
      step.receivers.normal.set(i, geometric * (dot(geometric, outgoing) < 0 ? -1.0f : 1.0f));
      step.paths.is_spread[i] = 1;
      return Kind::plain;
    }
    step.looks[i] = look_at(desc, material, *prepared, point);
    const Vec3 coat_normal =
        prepared->has_coat ? bumped(mapped_normal(scene_, hit, step.surfaces[i], material.coat_normal_texture,
                                                  material.coat_normal_scale))
                           : normal;
    const Bsdf& bsdf = step.bsdfs[i].emplace(step.looks[i], step.surfaces[i], normal, outgoing, coat_normal);
    step.receivers.normal.set(i, bsdf.spreads_behind() ? Vec3{0, 0, 0} : bsdf.facing_normal());
    step.paths.is_spread[i] = bsdf.has_spread();
    return Kind::other;
  }

  /// The path of point `i` goes on.
  static void go_on(PathBatch& batch, const Step& step, int i) {
    const std::uint32_t place = step.places[i];
    Path& path = batch[place];
    const Vec3 direction = step.scattered.direction[i];
    const bool is_perfect = step.scattered.is_perfect[i] != 0;
    if (step.scattered.is_transmission[i] != 0)
      enter(path, *step.materials[i], step.surfaces.normal[i], direction);
    path.throughput = step.next.throughput[i];
    path.sampler.skip(static_cast<std::uint32_t>(step.draw_count(i) + (path.bounce >= kRouletteAfter)));
    path.pdf = step.scattered.pdf[i];
    path.is_perfect = is_perfect;
    if (!is_perfect) path.cone_angle = max(path.cone_angle, kScatteredAngle);
    ++path.bounce;
    batch.left_from(place) = {step.receivers.position[i], step.receivers.normal[i]};
    batch.next.add({step.next.origin[i], 0, direction, kInfinity}, place);
  }

  /// Adds the light that the surface sends out itself, in so far as it is this way's to find.
  void gather_emission(Work& work, std::uint32_t place, Vec3 direction, const Hit& hit,
                       const Surface& surface) const {
    const Path& path = work.batch[place];
    const Vec3 emission = lights_.emission(surface, direction);
    if (!(max_component(emission) > 0)) return;
    float weight = 1;
    if (!path.is_perfect)
      weight = power_heuristic(path.pdf, lights_.pdf(hit, surface, direction, work.batch.left_from(place)));
    work.gather(path.sample, path.throughput * emission * weight);
  }

  /// Remembers what the path is in, on the other side of a surface.
  static void enter(Path& path, const Material& material, Vec3 normal, Vec3 direction) {
    if (material.is_thin) return;
    path.absorption = dot(direction, normal) < 0 ? material.absorption : material.outer_absorption;
  }

  Vec3 background(Vec3 direction, const Path& path, const Receiver& from) const {
    Vec3 sum = lights_.dome(direction);
    lights_.for_each_far_light(direction, from, [&](const Lights::FarLight& light) {
      sum += light.radiance * (path.is_perfect ? 1 : power_heuristic(path.pdf, light.pdf));
    });
    return sum;
  }

  const PreparedMaterial& prepared(MaterialId id) const {
    return id.is_valid() ? materials_[id.value] : default_material_;
  }

  const Scene& scene_;
  SurfaceReader surfaces_;
  Lights lights_;
  Shadows shadows_;
  float pixel_angle_;
  int bounces_;
  std::vector<PreparedMaterial> materials_;
  std::vector<std::uint8_t> group_of_instance_;
  PreparedMaterial default_material_{Material{}};
};

}  // namespace

std::unique_ptr<Integrator> make_path_tracer(const Scene& scene, const Camera& camera, float pixel_angle,
                                             int bounces) {
  return std::make_unique<PathTracer>(scene, camera, pixel_angle, bounces);
}

}  // namespace boxwood::render
