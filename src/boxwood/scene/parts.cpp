#include "boxwood/scene/parts.h"

#include <chrono>
#include <stdexcept>

#include "boxwood/build/build.h"
#include "boxwood/core/prefetch.h"
#include "boxwood/core/raw_array.h"
#include "boxwood/scene/ray_order.h"
#include "boxwood/shape/instance.h"
#include "boxwood/tree/collapse.h"

namespace boxwood {
namespace {

constexpr std::size_t kGrain = 1 << 14;

/// Addresses, not memory: a build has less than that at any time.
constexpr std::size_t kWorkspacePerTriangle = 512;

std::size_t triangle_count(const SceneDesc& desc) {
  std::size_t count = 0;
  for (const Geometry& geometry : desc.geometries)
    if (std::holds_alternative<TriangleMesh>(geometry.shapes)) count += primitive_count(geometry);
  return count;
}

/// Adds the primitives of one geometry, as one instance shows them, to a part: meshes as a whole, for
/// build_triangles. `triangle_count` counts along.
void add_geometry(Part& part, std::size_t& triangle_count, const SceneDesc& desc, GeometryId geometry_id,
                  InstanceId instance_id) {
  const Geometry& geometry = desc.geometries[geometry_id.value];
  const std::size_t count = primitive_count(geometry);
  if (std::holds_alternative<TriangleMesh>(geometry.shapes)) {
    if (count == 0) return;
    part.meshes.push_back({static_cast<std::uint32_t>(triangle_count), instance_id, geometry_id});
    triangle_count += count;
    if (triangle_count >= kMaxPrimitives)
      throw std::invalid_argument("scene: there are " + std::to_string(triangle_count) +
                                  " triangles or more in one space, expected fewer than " +
                                  std::to_string(kMaxPrimitives));
  } else {
    for (std::size_t i = 0; i < count; ++i) part.shapes.push_back({geometry_id, instance_id, PrimId(i)});
  }
}

/// Fills mesh_of_page for `count` triangles.
void index_meshes(Part& part, std::size_t count) {
  std::uint32_t mesh = 0;
  for (std::size_t key = 0; key < count; key += std::size_t(1) << Part::kPageBits) {
    while (mesh + 1 < part.meshes.size() && part.meshes[mesh + 1].first_key <= key) ++mesh;
    part.mesh_of_page.push_back(mesh);
  }
  if (count > 0) part.mesh_of_page.push_back(static_cast<std::uint32_t>(part.meshes.size() - 1));
}

/// Builds the tree over the part's meshes, for nodes of W children.
template <int W>
simd::TriangleTree build_triangles(Part& part, const SceneDesc& desc, const BuildOptions& options,
                                   Executor& executor) {
  // Tell the builder the boxes, in the order of the keys. Triangles stay in their meshes until their place is
  // known: a copy in between costs more time than it saves, and memory.
  std::size_t count = 0;
  for (const PartMesh& mesh : part.meshes) count += primitive_count(desc.geometries[mesh.geometry_id.value]);
  index_meshes(part, count);
  std::vector<const TriangleMesh*> mesh_of_part;
  for (const PartMesh& mesh : part.meshes)
    mesh_of_part.push_back(&std::get<TriangleMesh>(desc.geometries[mesh.geometry_id.value].shapes));
  /// Where a triangle's vertices are, and which of them it has.
  struct Place {
    const Vec3* vertices;
    const std::array<std::uint32_t, 3>* indices;
  };
  const auto place_of_key = [&](PrimId key) -> Place {
    const PartMesh& part_mesh = part.mesh_of(key.value);
    const TriangleMesh& mesh = *mesh_of_part[std::size_t(&part_mesh - part.meshes.data())];
    return {mesh.positions.data(), &mesh.indices[key.value - part_mesh.first_key]};
  };
  const auto corners_at = [](const Place& place) -> simd::Corners {
    const auto& [i, j, k] = *place.indices;
    return {place.vertices, {i, j, k}};
  };

  const BoxSource source = [&](std::size_t begin, std::size_t end, Box3* boxes) {
    while (begin < end) {
      const PartMesh& part_mesh = part.mesh_of(static_cast<std::uint32_t>(begin));
      const TriangleMesh& mesh = *mesh_of_part[std::size_t(&part_mesh - part.meshes.data())];
      const std::size_t first = part_mesh.first_key, stop = std::min(end, first + mesh.indices.size());
      for (; begin < stop; ++begin) *boxes++ = triangle_of(mesh, PrimId(begin - first)).box();
    }
  };

  // Build and collapse; let go of what the next step does not need.
  BuildOptions in_blocks = options;
  in_blocks.block_size = kBlockWidth;  // a block is tested at the price of one triangle
  WideBvh<W> wide;
  if (options.split_share > 0) {
    RawArray<Box3> boxes(count);
    parallel_for(executor, 0, (count + kSourceBlock - 1) / kSourceBlock, kGrain / kSourceBlock,
                 [&](std::size_t block) {
                   const std::size_t begin = block * kSourceBlock;
                   source(begin, std::min(count, begin + kSourceBlock), &boxes[begin]);
                 });
    const Clip clip = [&](PrimId key, const Box3& region) {
      return corners_at(place_of_key(key)).triangle().clipped_box(region);
    };
    const Bvh bvh = build(std::span<const Box3>(boxes.data(), count), clip, in_blocks);
    boxes = {};
    wide = collapse<W>(bvh, executor);
    wide.has_parts = bvh.prim_ids.size() > count;
  } else {
    const RawBvh bvh = build_raw(count, source, in_blocks);
    wide = collapse<W>(bvh.view(), executor);
  }
  const simd::TriangleTree::Fetch fetch = [&](std::span<const PrimId> keys, simd::Corners* corners) {
    // Neighbours in the tree may be far apart in the meshes: ask for all before the first is waited for.
    Place places[simd::TriangleTree::kMaxFetch];
    for (std::size_t i = 0; i < keys.size(); ++i) {
      places[i] = place_of_key(keys[i]);
      prefetch(places[i].indices);
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      corners[i] = corners_at(places[i]);
      for (const std::uint32_t vertex : corners[i].index) prefetch(corners[i].vertices + vertex);
    }
  };
  simd::TriangleTree tree(wide, fetch, options.is_compact ? simd::Layout::compact : simd::Layout::full,
                          executor);
  part.may_sort_rays = detail::may_be_worth_sorting(tree.size_bytes(), wide.cost);
  return tree;
}

/// Builds a tree over `items`, puts them into leaf order and makes prim_ids count along.
template <class Item, class BoxOf>
Bvh build_in_leaf_order(std::vector<Item>& items, const BoxOf& box_of, const BuildOptions& options,
                        Executor& executor) {
  std::vector<Box3> boxes(items.size());
  parallel_for(executor, 0, items.size(), kGrain, [&](std::size_t i) { boxes[i] = box_of(items[i]); });
  Bvh bvh = build(boxes, options);

  std::vector<Item> ordered(items.size());
  parallel_for(executor, 0, items.size(), kGrain, [&](std::size_t i) {
    ordered[i] = items[bvh.prim_ids[i].value];
    bvh.prim_ids[i] = PrimId(i);
  });
  items = std::move(ordered);
  return bvh;
}

void build_trees(Part& part, const SceneDesc& desc, const BuildOptions& options, int width,
                 Executor& executor) {
  part.triangles =
      with_width(width, [&](auto w) { return build_triangles<w()>(part, desc, options, executor); });
  part.shape_bvh = build_in_leaf_order(
      part.shapes,
      [&](const LeafShape& s) {
        return with_shape(desc.geometries[s.geometry_id.value], s.primitive_id,
                          [](const auto& shape) { return shape.box(); });
      },
      options, executor);
  part.bounds = unite(part.triangles.box(), part.shape_bvh.bounds());
}

/// What kernels walk below the placements of `parts`, which are in the order of their tree.
template <int W>
simd::PlacedTrees place_trees(const Scene::Parts& parts, Executor& executor) {
  std::vector<Box3> boxes;
  std::vector<simd::PlacedTree> items;
  for (const Placement& placement : parts.placements) {
    const Part& object = parts.objects[placement.part_index];
    const simd::TriangleTree* tree = object.triangles.is_empty() ? nullptr : &object.triangles;
    boxes.push_back(placement.world_box);
    items.push_back({placement.object_from_world, placement.world_box, object.bounds, tree,
                     object.triangles.pool(), object.triangles.box_slack(), placement.instance_id.value,
                     parts.instances[placement.instance_id.value].geometry.value});
  }
  return {simd::BoxTree(collapse<W>(parts.top_level, executor, {.leaf_size = 1}), boxes), std::move(items)};
}

/// Why the nearest point of `geometry` under a transform is not known; empty when it is.
std::string closest_point_obstacle(const Geometry& geometry, bool under_similarity) {
  if (std::holds_alternative<TriangleMesh>(geometry.shapes) ||
      std::holds_alternative<std::vector<Quad>>(geometry.shapes))
    return "";
  if (!under_similarity) return "it has shapes under a transform that is not a similarity";
  if (const auto* shapes = std::get_if<std::vector<AnyShape>>(&geometry.shapes))
    for (const AnyShape& shape : *shapes)
      if (!shape.get().has_closest_point()) return "it has a shape that knows no closest point";
  return "";
}

}  // namespace

std::unique_ptr<const Scene::Parts> build_parts(SceneDesc desc, const BuildOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Executor& executor = options.executor ? *options.executor : default_executor();
  check(desc, executor);
  const Workspace workspace(kWorkspacePerTriangle * triangle_count(desc));

  auto parts = std::make_unique<Scene::Parts>();
  parts->desc = std::move(desc);
  parts->instances = placed_instances(parts->desc);

  // Sort what is placed: into the world, or into an object of its own.
  constexpr std::uint32_t kNoPart = 0xffffffffu;
  std::size_t world_triangles = 0;
  std::vector<std::uint32_t> part_of_geometry(parts->desc.geometries.size(), kNoPart);
  parts->object_from_world.resize(parts->instances.size());
  for (std::size_t i = 0; i < parts->instances.size(); ++i) {
    const Instance& instance = parts->instances[i];
    const Geometry& geometry = parts->desc.geometries[instance.geometry.value];
    bool under_similarity = true;
    parts->is_moved.push_back(!(instance.world_from_object == Affine3::identity()));
    if (!parts->is_moved.back()) {
      add_geometry(parts->world, world_triangles, parts->desc, instance.geometry, InstanceId(i));
    } else {
      std::uint32_t& part_index = part_of_geometry[instance.geometry.value];
      if (part_index == kNoPart) {
        part_index = static_cast<std::uint32_t>(parts->objects.size());
        std::size_t triangles = 0;
        add_geometry(parts->objects.emplace_back(), triangles, parts->desc, instance.geometry, InstanceId());
      }
      parts->object_from_world[i] = inverse(instance.world_from_object);
      under_similarity = is_similarity(instance.world_from_object);
      parts->placements.push_back({InstanceId(i), part_index, instance.world_from_object,
                                   parts->object_from_world[i], Box3{}, under_similarity});
    }
    if (parts->closest_point_obstacle.empty())
      parts->closest_point_obstacle = closest_point_obstacle(geometry, under_similarity);
  }

  // Build from the inside out: objects, world, placements.
  const simd::Kernels* kernels = simd::kernels();
  const int width = kernels ? kernels->width : 8;
  for (Part& object : parts->objects) build_trees(object, parts->desc, options, width, executor);
  build_trees(parts->world, parts->desc, options, width, executor);
  for (Placement& placement : parts->placements)
    placement.world_box =
        transform_box(placement.world_from_object, parts->objects[placement.part_index].bounds);
  for (const Placement& placement : parts->placements)
    if (!placement.world_box.is_empty() &&
        !(is_finite(placement.world_box.lower) && is_finite(placement.world_box.upper)))
      throw std::invalid_argument("scene: instance " + std::to_string(placement.instance_id.value) +
                                  " reaches beyond what a float can hold");
  BuildOptions top_level = options;
  top_level.leaf_size = 1;  // a tree below each, which costs much more than a box
  parts->top_level = build_in_leaf_order(
      parts->placements, [](const Placement& p) { return p.world_box; }, top_level, executor);
  parts->placed_trees = with_width(width, [&](auto w) { return place_trees<w()>(*parts, executor); });
  parts->bounds = unite(parts->world.bounds, parts->top_level.bounds());

  // Choose who answers.
  Box3 shapes_box = parts->world.shape_bvh.bounds();
  for (const Placement& placement : parts->placements)
    if (!parts->objects[placement.part_index].shapes.empty()) {
      parts->has_placed_shapes = true;
      shapes_box.extend(placement.world_box);
    }
  parts->has_shapes = parts->has_placed_shapes || !parts->world.shapes.empty();
  parts->shapes_ball = Ball(shapes_box, parts->bounds);
  parts->is_only_triangles = !parts->has_shapes && parts->placements.empty();
  if (parts->world.triangles.is_ordinary() &&
      (!parts->placed_trees.has_triangles() || parts->placed_trees.is_ordinary()))
    parts->kernels = kernels;

  parts->build_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return parts;
}

}  // namespace boxwood
