#include "boxwood/render/aov.h"

#include "boxwood/render/material.h"
#include "boxwood/render/sky.h"
#include "boxwood/render/warp.h"
#include "boxwood/scene/srgb.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {
namespace {

/// The textbook's ray tracer: each pixel takes the color of the shape that its ray hits. A lamp shows the hue
/// of its light, and where nothing is hit stands the sky, if the scene has one.
class ColorIntegrator final : public Integrator {
 public:
  explicit ColorIntegrator(const Scene& scene) : scene_(scene) {}
  int channels() const override { return 3; }
  bool sample(const Ray& ray, Sampler&, std::span<float> out, RayCounts& rays) const override {
    ++rays.camera;
    store(out, color(ray));
    return true;
  }

 private:
  Vec3 color(const Ray& ray) const {
    const SceneDesc& desc = scene_.description();
    const Hit hit = scene_.closest_hit(ray);
    if (!hit) return desc.sky ? min(sky_radiance(*desc.sky, ray.direction), {1, 1, 1}) : Vec3{0, 0, 0};
    const Surface surface = surface_at(scene_, ray, hit);
    const Material& material = material_of(desc, surface.material);
    if (is_emissive(material)) return material.emission / max(1.0f, max_component(material.emission));
    return base_color(desc, material, TexturePoint(scene_, hit, surface));
  }
  const Scene& scene_;
};

class NormalIntegrator final : public Integrator {
 public:
  explicit NormalIntegrator(const Scene& scene) : scene_(scene) {}
  int channels() const override { return 3; }
  bool sample(const Ray& ray, Sampler&, std::span<float> out, RayCounts& rays) const override {
    ++rays.camera;
    const Hit hit = scene_.closest_hit(ray);
    store(out, hit ? surface_at(scene_, ray, hit).shading_normal : Vec3{0, 0, 0});
    return true;
  }

 private:
  const Scene& scene_;
};

/// The distance along the ray. Misses are not counted, so the edge of a thing is as far away as the thing.
class DepthIntegrator final : public Integrator {
 public:
  explicit DepthIntegrator(const Scene& scene) : scene_(scene) {}
  int channels() const override { return 1; }
  bool sample(const Ray& ray, Sampler&, std::span<float> out, RayCounts& rays) const override {
    ++rays.camera;
    const Hit hit = scene_.closest_hit(ray);
    out[0] = hit.t;  // in units of a unit direction, so this is a distance
    return hit.is_hit();
  }

 private:
  const Scene& scene_;
};

/// The share of the cosine-weighted hemisphere that is open up to a third of the scene's diagonal. Black
/// where nothing is hit.
class OcclusionIntegrator final : public Integrator {
 public:
  explicit OcclusionIntegrator(const Scene& scene)
      : scene_(scene), reach_(0.33f * length(scene.bounds().is_empty() ? Vec3{} : scene.bounds().extent())) {}
  int channels() const override { return 1; }
  bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, RayCounts& rays) const override {
    ++rays.camera;
    out[0] = 0;
    const Hit hit = scene_.closest_hit(ray);
    if (!hit) return true;

    // Look around on the side that the ray came from.
    const Surface surface = surface_at(scene_, ray, hit);
    const bool is_outside = dot(surface.normal, ray.direction) < 0;
    const Frame frame(is_outside ? surface.shading_normal : -surface.shading_normal);
    const Vec3 direction = frame.to_world(cosine_hemisphere(sampler.next_2d()));

    // An interpolated normal's hemisphere dips below the surface itself;
    // what is seen there is the surface: shut in.
    const bool is_above = (dot(direction, surface.normal) > 0) == is_outside;
    ++rays.shadow;
    out[0] = is_above && !scene_.any_hit(surface.spawn(direction, reach_)) ? 1.0f : 0.0f;
    return true;
  }

 private:
  const Scene& scene_;
  float reach_;
};

class CostIntegrator final : public Integrator {
 public:
  explicit CostIntegrator(const Scene& scene) : scene_(scene) {}
  int channels() const override { return 2; }
  bool sample(const Ray& ray, Sampler&, std::span<float> out, RayCounts& rays) const override {
    ++rays.camera;
    TraversalStatistics statistics;
    (void)scene_.closest_hit(ray, statistics);
    out[0] = static_cast<float>(statistics.box_tests);
    out[1] = static_cast<float>(statistics.shape_tests);
    return true;
  }

 private:
  const Scene& scene_;
};

}  // namespace

std::unique_ptr<Integrator> make_aov(const Scene& scene, Mode mode) {
  switch (mode) {
    case Mode::color:
      return std::make_unique<ColorIntegrator>(scene);
    case Mode::normal:
      return std::make_unique<NormalIntegrator>(scene);
    case Mode::depth:
      return std::make_unique<DepthIntegrator>(scene);
    case Mode::occlusion:
      return std::make_unique<OcclusionIntegrator>(scene);
    case Mode::cost:
      return std::make_unique<CostIntegrator>(scene);
    case Mode::path:
      break;
  }
  throw std::invalid_argument("make_aov: path is not one of its modes");
}

Image depth_as_grey(const Image& depth) {
  float nearest = kInfinity, farthest = 0;
  for (const float d : depth.pixels) {
    if (d <= 0) continue;
    nearest = min(nearest, d);
    farthest = max(farthest, d);
  }
  Image grey = depth;
  for (float& d : grey.pixels) {
    if (d <= 0) continue;
    const float share = farthest > nearest ? (d - nearest) / (farthest - nearest) : 0;
    d = linear_from_srgb(1 - 0.88f * share);
  }
  return grey;
}

Image occlusion_as_grey(const Image& occlusion) {
  Image grey = occlusion;
  for (float& share : grey.pixels) share = linear_from_srgb(share);
  return grey;
}

Image normal_as_color(const Image& normal) {
  Image color = normal;
  for (float& n : color.pixels) n = linear_from_srgb(min(max(0.5f + 0.5f * n, 0.0f), 1.0f));
  return color;
}

}  // namespace boxwood::render
