#include "pickles.h"

#include <cstring>
#include <stdexcept>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace boxwood::python {
namespace {

[[noreturn]] void refuse() {
  throw std::invalid_argument("this pickle is damaged, or of another version of boxwood");
}

/// A part of a state as what it must be.
template <class T>
T as(nb::handle part) {
  try {
    return nb::cast<T>(part);
  } catch (const std::bad_cast&) {
    refuse();
  }
}

/// A state of so many parts.
nb::tuple parts_of(nb::handle state, std::size_t count) {
  nb::tuple parts = as<nb::tuple>(state);
  if (parts.size() != count) refuse();
  return parts;
}

template <class T>
nb::bytes bytes_of(const T* items, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  return nb::bytes(reinterpret_cast<const char*>(items), count * sizeof(T));
}

template <class T>
nb::bytes bytes_of(const std::vector<T>& items) {
  return bytes_of(items.data(), items.size());
}

template <class T>
std::vector<T> items_of(nb::handle part) {
  const nb::bytes bytes = as<nb::bytes>(part);
  if (bytes.size() % sizeof(T) != 0) refuse();
  std::vector<T> items(bytes.size() / sizeof(T));
  std::memcpy(static_cast<void*>(items.data()), bytes.c_str(), bytes.size());
  return items;
}

// Results: their shape, and their columns as arrays.

template <class Visit>
void visit_columns(HitColumns& c, const Block& block, const Shape& rows, const Visit& visit) {
  visit(c.t, block, rows);
  visit(c.ids.primitive_id, block, rows);
  visit(c.ids.geometry_id, block, rows);
  visit(c.ids.instance_id, block, rows);
  visit(c.part, block, rows);
  visit(c.uv, block, rows);
  visit(c.normal, block, rows);
  visit(c.position, block, rows);
}

template <class Visit>
void visit_columns(Hits& hits, const Visit& visit) {
  visit_columns(hits.columns, hits.block, hits.shape, visit);
}

template <class Visit>
void visit_columns(AllHits& hits, const Visit& visit) {
  visit(hits.offsets, hits.offset_block, Shape{count_of(hits.shape) + 1});
  visit_columns(hits.columns, hits.block, Shape{hits.count}, visit);
}

template <class Visit>
void visit_columns(Points& points, const Visit& visit) {
  visit(points.distance, points.block, points.shape);
  visit(points.position, points.block, points.shape);
  visit(points.ids.primitive_id, points.block, points.shape);
  visit(points.ids.geometry_id, points.block, points.shape);
  visit(points.ids.instance_id, points.block, points.shape);
}

template <class Visit>
void visit_columns(Surfaces& surfaces, const Visit& visit) {
  visit(surfaces.position, surfaces.block, surfaces.shape);
  visit(surfaces.error, surfaces.block, surfaces.shape);
  visit(surfaces.normal, surfaces.block, surfaces.shape);
  visit(surfaces.shading_normal, surfaces.block, surfaces.shape);
  visit(surfaces.uv, surfaces.block, surfaces.shape);
}

template <class Result>
nb::list columns_of(Result& result) {
  nb::list columns;
  visit_columns(result, [&](auto& column, const Block& block, const Shape& rows) {
    columns.append(column.get(block, rows));
  });
  return columns;
}

template <class Result>
void copy_columns(Result& result, nb::handle part) {
  const nb::list columns = as<nb::list>(part);
  const nb::object copy = nb::module_::import_("numpy").attr("copyto");
  std::size_t next = 0;
  visit_columns(result, [&](auto& column, const Block& block, const Shape& rows) {
    if (next >= columns.size()) refuse();
    const nb::object to = column.get(block, rows), from = columns[next++];
    if (!nb::hasattr(from, "shape") || !from.attr("shape").equal(to.attr("shape"))) refuse();
    copy(to, from);
  });
  if (next != columns.size()) refuse();
}

/// Of a result whose shape says how large it is.
template <class Result>
Result result_of(const nb::tuple& state) {
  const nb::tuple parts = parts_of(state, 2);
  Result result(as<Shape>(parts[0]));
  copy_columns(result, parts[1]);
  return result;
}

}  // namespace

nb::tuple state_of(const SceneDesc& desc) {
  nb::list geometries;
  for (const Geometry& geometry : desc.geometries) {
    nb::list columns;
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
      columns.append(bytes_of(mesh->positions));
      columns.append(bytes_of(mesh->indices));
      columns.append(bytes_of(mesh->normals));
      columns.append(bytes_of(mesh->uvs));
    } else if (const auto* spheres = std::get_if<std::vector<Sphere>>(&geometry.shapes)) {
      columns.append(bytes_of(*spheres));
    } else if (const auto* quads = std::get_if<std::vector<Quad>>(&geometry.shapes)) {
      columns.append(bytes_of(*quads));
    } else if (const auto* cuboids = std::get_if<std::vector<Cuboid>>(&geometry.shapes)) {
      columns.append(bytes_of(*cuboids));
    } else if (const auto* disks = std::get_if<std::vector<Disk>>(&geometry.shapes)) {
      columns.append(bytes_of(*disks));
    } else {
      throw nb::type_error("a scene with shapes of a user's own kind cannot be pickled");
    }
    geometries.append(nb::make_tuple(geometry.name, geometry.shapes.index(), nb::tuple(columns)));
  }
  nb::object camera = desc.camera ? nb::object(state_of(*desc.camera)) : nb::none();
  return nb::make_tuple(desc.name, nb::tuple(geometries), bytes_of(desc.instances), camera, desc.warnings);
}

template <>
SceneDesc from_state(const nb::tuple& state) {
  const nb::tuple parts = parts_of(state, 5);
  SceneDesc desc;
  desc.name = as<std::string>(parts[0]);
  for (nb::handle entry : as<nb::tuple>(parts[1])) {
    const nb::tuple geometry = parts_of(entry, 3);
    const int kind = as<int>(geometry[1]);
    const nb::tuple columns = parts_of(geometry[2], kind == 0 ? 4 : 1);
    Shapes shapes;
    switch (kind) {
      case 0:
        shapes = TriangleMesh{items_of<Vec3>(columns[0]), items_of<std::array<std::uint32_t, 3>>(columns[1]),
                              items_of<Vec3>(columns[2]), items_of<Vec2>(columns[3])};
        break;
      case 1:
        shapes = items_of<Sphere>(columns[0]);
        break;
      case 2:
        shapes = items_of<Quad>(columns[0]);
        break;
      case 3:
        shapes = items_of<Cuboid>(columns[0]);
        break;
      case 4:
        shapes = items_of<Disk>(columns[0]);
        break;
      default:
        refuse();
    }
    desc.add(Geometry{std::move(shapes), {}, {}, as<std::string>(geometry[0])});
  }
  desc.instances = items_of<Instance>(parts[2]);
  if (!parts[3].is_none()) desc.camera = from_state<Camera>(as<nb::tuple>(parts[3]));
  desc.warnings = as<std::vector<std::string>>(parts[4]);
  return desc;
}

nb::tuple state_of(const BuildOptions& o) {
  return nb::make_tuple(static_cast<int>(o.method), o.max_depth, o.leaf_size, o.block_size, o.bins,
                        o.traversal_cost, o.reinsertion_rounds, o.reinsertion_share, o.split_share,
                        o.is_compact);
}

template <>
BuildOptions from_state(const nb::tuple& state) {
  const nb::tuple parts = parts_of(state, 10);
  const int method = as<int>(parts[0]);
  if (method < 0 || method > static_cast<int>(Method::ploc)) refuse();
  BuildOptions o;
  o.method = static_cast<Method>(method);
  o.max_depth = as<int>(parts[1]);
  o.leaf_size = as<int>(parts[2]);
  o.block_size = as<int>(parts[3]);
  o.bins = as<int>(parts[4]);
  o.traversal_cost = as<float>(parts[5]);
  o.reinsertion_rounds = as<int>(parts[6]);
  o.reinsertion_share = as<float>(parts[7]);
  o.split_share = as<float>(parts[8]);
  o.is_compact = as<bool>(parts[9]);
  return o;
}

nb::tuple state_of(const Camera& camera) {
  return nb::make_tuple(bytes_of(&camera, 1));
}

template <>
Camera from_state(const nb::tuple& state) {
  const auto cameras = items_of<Camera>(parts_of(state, 1)[0]);
  if (cameras.size() != 1) refuse();
  return cameras[0];
}

nb::tuple state_of(const SceneObject& s) {
  return nb::make_tuple(state_of(s.scene.description()), state_of(s.options));
}

template <>
SceneObject from_state(const nb::tuple& state) {
  const nb::tuple parts = parts_of(state, 2);
  return build_scene(from_state<SceneDesc>(as<nb::tuple>(parts[0])),
                     from_state<BuildOptions>(as<nb::tuple>(parts[1])), nb::int_(0));
}

nb::tuple state_of(Hits& hits) {
  return nb::make_tuple(hits.shape, columns_of(hits));
}
nb::tuple state_of(AllHits& hits) {
  return nb::make_tuple(hits.shape, hits.count, columns_of(hits));
}
nb::tuple state_of(Points& points) {
  return nb::make_tuple(points.shape, columns_of(points));
}
nb::tuple state_of(Surfaces& surfaces) {
  return nb::make_tuple(surfaces.shape, columns_of(surfaces));
}

template <>
Hits from_state(const nb::tuple& state) {
  return result_of<Hits>(state);
}
template <>
Points from_state(const nb::tuple& state) {
  return result_of<Points>(state);
}
template <>
Surfaces from_state(const nb::tuple& state) {
  return result_of<Surfaces>(state);
}
template <>
AllHits from_state(const nb::tuple& state) {
  const nb::tuple parts = parts_of(state, 3);
  AllHits hits(as<Shape>(parts[0]));
  hits.make_room(as<std::size_t>(parts[1]));
  copy_columns(hits, parts[2]);
  return hits;
}

}  // namespace boxwood::python
