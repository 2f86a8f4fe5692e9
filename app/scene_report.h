// scene_report.h: what is in a scene, what do its trees look like, and what do they cost?
//
// Plain data, gathered once; cmd_info.cpp shows it to people and as JSON.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "boxwood/scene/scene.h"
#include "boxwood/tree/metrics.h"

namespace boxwood::app {

/// One tree of the scene. In order: the world's trees, each object's, and the one over the placed objects.
struct TreeReport {
  std::string name;  ///< "world: triangles", "object 3 'wheel': shapes", "instances".
  TreeShape shape;
  double sah_cost = 0;
  /// None where nearly everything overlaps: there it is huge, and takes quadratic time to say how huge.
  std::optional<double> end_point_overlap;
};

struct SceneReport {
  std::string name;

  // What is in it.
  std::map<std::string, std::size_t> geometries;  ///< Kind -> how many geometries are of it.
  std::map<std::string, std::size_t> primitives;  ///< Kind -> how many primitives are defined.
  std::size_t defined_primitives = 0, shown_primitives = 0;
  std::size_t instances = 0;
  std::map<std::string, std::size_t> materials;  ///< Kind -> how many materials are of it.
  std::size_t textures = 0, cached_textures = 0, texels = 0;
  std::size_t emissive_materials = 0, point_lights = 0, distant_lights = 0;
  bool has_sky = false, has_sun = false;
  Box3 bounds;  ///< Empty when nothing can be hit.
  std::vector<std::string> warnings;

  // What its trees look like; trees of nothing are left out.
  std::vector<TreeReport> trees;

  // What it costs.
  std::size_t tree_bytes = 0, geometry_bytes = 0, texture_bytes = 0;
  double build_ms = 0;
};

/// The trees are measured on `executor`; the result does not depend on it.
SceneReport report(const Scene& scene, Executor& executor);

}  // namespace boxwood::app
