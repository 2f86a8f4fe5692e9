// models.h: which real scenes do these tests look at, and with which rays?
//
// The folder comes from the environment variable BOXWOOD_MODELS;
// without it every test here skips, and says so.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/io/load.h"
#include "boxwood/scene/scene.h"

namespace boxwood::test {

struct Model {
  const char* path;
  std::size_t triangles;
};

inline constexpr Model kModels[] = {
    {"bunny.obj", 69451},      {"dragon.ply", 202520},        {"kitchen/scene.pbrt", 1443517},
    {"Duck.glb", 4212},        {"CesiumMilkTruck.glb", 3624}, {"BoxTextured.glb", 12},
    {"BoxInterleaved.glb", 12}};

inline std::filesystem::path models_folder() {
  const char* folder = std::getenv("BOXWOOD_MODELS");
  return folder ? folder : "";
}

/// One test for each model; a scene is loaded and built once for all of them.
class OnModel : public ::testing::TestWithParam<Model> {
 protected:
  void SetUp() override {
    if (models_folder().empty()) GTEST_SKIP() << "BOXWOOD_MODELS is not set: no models to test on";
  }
  static const Scene& scene() {
    static std::map<std::string, std::unique_ptr<Scene>> scenes;
    std::unique_ptr<Scene>& scene = scenes[GetParam().path];
    if (!scene) scene = std::make_unique<Scene>(io::load(models_folder() / GetParam().path));
    return *scene;
  }
};

inline std::string model_name(const ::testing::TestParamInfo<Model>& info) {
  std::string name = info.param.path;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

/// A third from outside towards the bounds,
/// a third from inside in all directions, a third that leaves a surface.
inline std::vector<Ray> model_rays(const Scene& scene, std::size_t count) {
  Random random(17);
  const Box3 box = scene.bounds();
  const float size = length(box.extent());
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    if (i % 3 == 0) {
      ray.origin = box.center() + random.direction() * size;
      ray.direction = random.in_box(box.lower, box.upper) - ray.origin;
    } else if (i % 3 == 1) {
      ray.origin = random.in_box(box.lower, box.upper);
      ray.direction = random.direction();
    } else {
      // Go on from where the ray before last hit, off the surface.
      const Ray& before = rays[i - 2];
      const Hit hit = scene.closest_hit(before);
      ray = hit.is_hit() ? Ray{before.at(hit.t * 0.999f), 0, random.direction()} : before;
      if (i % 2) ray.t_max = size * random.uniform();
    }
  }
  return rays;
}

}  // namespace boxwood::test
