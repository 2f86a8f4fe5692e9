#include "boxwood/render/path.h"

#include <vector>

#include "boxwood/render/bsdf.h"
#include "boxwood/render/light.h"
#include "boxwood/render/material.h"

namespace boxwood::render {
namespace {

// A bound for light that is caught in glass; roulette ends other paths long before.
constexpr int kMaxBounces = 64;
constexpr int kRouletteAfter = 3;  // bounces; early ones carry most of the picture
constexpr float kMaxSurvival = 0.95f;

/// The weight of a sample of density `a` when the same light could
/// have been found with density `b`: Veach's power heuristic.
float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

class PathTracer final : public Integrator {
 public:
  PathTracer(const Scene& scene, const Camera& camera) : scene_(scene), lights_(scene, camera) {
    for (const Material& material : scene.description().materials) materials_.emplace_back(material);
  }

  int channels() const override { return 3; }
  bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, std::uint64_t& rays) const override {
    store(out, radiance(ray, sampler, rays));
    return true;
  }

 private:
  /// Where the path stands, and how it got there:
  /// which part of the light that it may run into now is its own.
  struct Vertex {
    Receiver place;  // the last point of the path
    float pdf = 0;   // of the direction taken from there
    // Next-event estimation could not have found what this direction finds; true at the camera.
    bool is_perfect = true;
  };

  Vec3 radiance(Ray ray, Sampler& sampler, std::uint64_t& rays) const {
    Vec3 gathered, throughput{1, 1, 1};
    Vertex last;
    for (int bounce = 0;; ++bounce) {
      ++rays;
      const Hit hit = scene_.closest_hit(ray);
      if (!hit) return gathered + throughput * background(ray.direction, last);

      // Light from the surface itself.
      const Surface surface = surface_at(scene_, ray, hit);
      const Vec3 emission = lights_.emission(surface, ray.direction);
      if (max_component(emission) > 0) {
        const float other = last.is_perfect ? 0 : lights_.pdf(hit, surface, ray.direction, last.place);
        gathered += throughput * emission * (last.is_perfect ? 1 : power_heuristic(last.pdf, other));
      }
      if (bounce == kMaxBounces) return gathered;

      // Light that one light source sends here, if nothing is in the way.
      const Material& material = material_of(scene_.description(), surface.material);
      const Vec3 color = base_color(scene_.description(), material, surface.uv);
      const Bsdf bsdf(prepared(surface.material), color, surface, -ray.direction);
      if (bsdf.has_spread()) gathered += throughput * direct_light(surface, bsdf, sampler, rays);

      // Go on in a direction that the surface chooses.
      const float choice = sampler.next_1d();
      const std::optional<BsdfSample> next = bsdf.sample(choice, sampler.next_2d());
      if (!next) return gathered;
      throughput *= next->weight;

      // Russian roulette: end paths that carry little, and let the others stand for them.
      if (bounce >= kRouletteAfter) {
        const float survival = min(max_component(throughput), kMaxSurvival);
        if (!(sampler.next_1d() < survival)) return gathered;
        throughput *= 1 / survival;
      }
      last = {{surface.position, bsdf.facing_normal()}, next->pdf, next->is_perfect};
      ray = surface.spawn(next->direction);
    }
  }

  Vec3 background(Vec3 direction, const Vertex& last) const {
    float sun_pdf = 0;
    const Vec3 sun = lights_.sun(direction, last.place, sun_pdf);
    return lights_.dome(direction) + sun * (last.is_perfect ? 1 : power_heuristic(last.pdf, sun_pdf));
  }

  Vec3 direct_light(const Surface& surface, const Bsdf& bsdf, Sampler& sampler, std::uint64_t& rays) const {
    const float choice = sampler.next_1d();
    const auto light = lights_.sample(surface, bsdf.facing_normal(), choice, sampler.next_2d());
    if (!light) return {};
    const BsdfValue toward = bsdf.evaluate(light->direction);
    if (!(max_component(toward.value) > 0)) return {};
    ++rays;
    if (scene_.any_hit(light->shadow_ray)) return {};
    const float weight = light->is_perfect ? 1 : power_heuristic(light->pdf, toward.pdf);
    return toward.value * light->radiance * (weight / light->pdf);
  }

  const PreparedMaterial& prepared(MaterialId id) const {
    return id.is_valid() ? materials_[id.value] : default_material_;
  }

  const Scene& scene_;
  Lights lights_;
  std::vector<PreparedMaterial> materials_;
  PreparedMaterial default_material_{Material{}};
};

}  // namespace

std::unique_ptr<Integrator> make_path_tracer(const Scene& scene, const Camera& camera) {
  return std::make_unique<PathTracer>(scene, camera);
}

}  // namespace boxwood::render
