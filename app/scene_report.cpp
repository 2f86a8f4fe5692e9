#include "scene_report.h"

#include "boxwood/core/parallel.h"
#include "boxwood/scene/parts.h"

namespace boxwood::app {
namespace {

constexpr double kMaxOverlapSteps = 3e8;  // some seconds

const char* kind_of(const Geometry& geometry) {
  constexpr const char* kNames[] = {"triangles", "spheres", "quads", "cuboids", "disks", "other shapes"};
  static_assert(std::size(kNames) == std::variant_size_v<Shapes>);
  return kNames[geometry.shapes.index()];
}

const char* kind_of(const Material& material) {
  switch (material.kind) {
    case Material::Kind::matte:
      return "matte";
    case Material::Kind::metal:
      return "metal";
    case Material::Kind::mirror:
      return "mirror";
    case Material::Kind::glass:
      return "glass";
    case Material::Kind::plastic:
      return "plastic";
    case Material::Kind::translucent:
      return "translucent";
    case Material::Kind::layered:
      return "layered";
    case Material::Kind::mix:
      return "mix";
    case Material::Kind::clear:
      return "clear";
  }
  return "unknown";
}

void count_contents(const SceneDesc& desc, SceneReport& out) {
  out.name = desc.name;
  for (const Geometry& geometry : desc.geometries) {
    ++out.geometries[kind_of(geometry)];
    out.primitives[kind_of(geometry)] += primitive_count(geometry);
  }
  out.defined_primitives = defined_primitive_count(desc);
  out.shown_primitives = shown_primitive_count(desc);
  out.instances = placed_instances(desc).size();

  for (const Material& material : desc.materials) {
    ++out.materials[kind_of(material)];
    out.emissive_materials += max_component(material.emission) > 0;
  }
  out.textures = desc.textures.size();
  for (const Texture& texture : desc.textures) {
    out.texels += std::size_t(texture.width) * texture.height;
    out.cached_textures += texture.source != nullptr;
    out.texture_bytes += texture.texels.size() * sizeof(texture.texels[0]);
  }
  out.point_lights = desc.point_lights.size();
  out.distant_lights = desc.distant_lights.size();
  out.has_sky = desc.sky.has_value();
  out.has_sun = desc.sky && max_component(desc.sky->sun_radiance) > 0;
  out.warnings = desc.warnings;
}

template <class Tree>
TreeReport report_tree(std::string name, const Tree& tree, const std::vector<Box3>& boxes) {
  TreeReport out{std::move(name), tree_shape(tree), sah_cost(tree), {}};

  // The overlap takes a walk for each primitive, and the cost says how long a walk is.
  if (out.sah_cost * static_cast<double>(boxes.size()) < kMaxOverlapSteps)
    out.end_point_overlap = end_point_overlap(tree, boxes);
  return out;
}

template <int W>
TreeReport report_triangles(std::string name, const simd::TriangleTree& tree) {
  // Keys count the part's triangles from 0.
  const WideBvh<W> wide = tree.unpack<W>();
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < tree.block_count(); ++i) {
    const simd::TriangleBlock block = tree.block(i);
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      if (block.key[lane] >= boxes.size()) boxes.resize(block.key[lane] + std::size_t(1));
      boxes[block.key[lane]] = block.triangle(lane).box();
    }
  }
  TreeReport out = report_tree(std::move(name), wide, boxes);

  // The slots have become blocks of triangles, which count as geometry.
  out.shape.size_bytes = tree.node_bytes();
  out.shape.bytes_per_primitive = double(tree.node_bytes()) / double(out.shape.primitive_count);
  return out;
}

void report_part(const std::string& name, const Part& part, const SceneDesc& desc,
                 std::vector<TreeReport>& out) {
  if (!part.triangles.is_empty())
    out.push_back(with_width(part.triangles.width(), [&](auto w) {
      return report_triangles<w()>(name + ": triangles", part.triangles);
    }));

  // The leaves hold the shapes in tree order, so these boxes are those that the tree was built over.
  std::vector<Box3> boxes;
  for (const LeafShape& s : part.shapes)
    boxes.push_back(with_shape(desc.geometries[s.geometry_id.value], s.primitive_id,
                               [](const auto& shape) { return shape.box(); }));
  if (!boxes.empty()) out.push_back(report_tree(name + ": shapes", part.shape_bvh, boxes));
}

/// "object 3 'wheel'": the name is that of the geometry that the object was made of.
std::vector<std::string> object_names(const Scene::Parts& parts) {
  std::vector<std::string> names(parts.objects.size());
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = "object " + std::to_string(i);

  std::vector<bool> is_done(names.size());
  for (const Placement& placement : parts.placements) {
    if (is_done[placement.part_index]) continue;
    is_done[placement.part_index] = true;
    const GeometryId geometry_id = parts.instances[placement.instance_id.value].geometry;
    const std::string& given = parts.desc.geometries[geometry_id.value].name;
    if (!given.empty()) names[placement.part_index] += " '" + given + "'";
  }
  return names;
}

}  // namespace

SceneReport report(const Scene& scene, Executor& executor) {
  const Scene::Parts& parts = scene.parts();
  SceneReport out;
  count_contents(parts.desc, out);
  out.bounds = scene.bounds();

  const std::vector<std::string> names = object_names(parts);

  // One slot for each part, so that the order does not depend on who is done first.
  std::vector<std::vector<TreeReport>> slots(parts.objects.size() + 2);
  parallel_for(executor, 0, slots.size(), 1, [&](std::size_t i) {
    if (i == 0) {
      report_part("world", parts.world, parts.desc, slots[i]);
    } else if (i <= parts.objects.size()) {
      report_part(names[i - 1], parts.objects[i - 1], parts.desc, slots[i]);
    } else if (!parts.placements.empty()) {
      std::vector<Box3> boxes;
      for (const Placement& placement : parts.placements) boxes.push_back(placement.world_box);
      slots[i].push_back(report_tree("instances", parts.top_level, boxes));
    }
  });
  for (std::vector<TreeReport>& slot : slots)
    for (TreeReport& tree : slot) out.trees.push_back(std::move(tree));

  const SceneStatistics statistics = scene.statistics();
  out.tree_bytes = statistics.tree_bytes;
  out.geometry_bytes = statistics.geometry_bytes;
  out.build_ms = statistics.build_ms;
  return out;
}

}  // namespace boxwood::app
