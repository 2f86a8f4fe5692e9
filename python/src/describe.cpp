#include "describe.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "docstrings.h"
#include "pickles.h"
#include "rows.h"

namespace boxwood::python {
namespace {

constexpr float kLargest = 0x1p126f;  // as check() in scene/description.h

/// A count and a noun: "1 mesh", "2 meshes".
std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

std::string number(double value) {
  return nb::cast<std::string>(nb::str(nb::float_(value)));
}

/// Throws unless the argument is a plain list of rows.
void expect_list(const Rows& rows, const Shape& row) {
  if (rows.shape().size() != 1) {
    std::string expected = "(n";
    for (const std::size_t size : row) expected += ", " + std::to_string(size);
    expected += row.empty() ? ",)" : ")";
    refuse(std::string(rows.name()) + ": got an array of shape " + to_string(rows.shape(), row) +
           ", expected shape " + expected);
  }
}

/// All rows of floats, each of them finite and not too large.
template <class T>
std::vector<T> read_floats(const char* name, nb::handle value, const Shape& row) {
  Rows rows(name, value, row);
  expect_list(rows, row);
  const std::size_t width = count_of(row);
  static_assert(sizeof(T) % sizeof(float) == 0);
  if (sizeof(T) != width * sizeof(float)) throw std::logic_error("read_floats: a row is not a T");
  std::vector<T> all(rows.count());
  float* const floats = reinterpret_cast<float*>(all.data());
  rows.read(0, rows.count(), floats, width);
  for (std::size_t i = 0; i < all.size() * width; ++i)
    if (!(std::abs(floats[i]) <= kLargest)) {
      const std::string place =
          row.empty() ? std::to_string(i) : std::to_string(i / width) + ", " + std::to_string(i % width);
      refuse(std::string(name) + "[" + place + "] is " + number(floats[i]) +
             ", expected a finite number up to 2^126");
    }
  return all;
}

void expect_length(const char* name, std::size_t got, const char* other, std::size_t expected) {
  if (got != expected)
    refuse(std::string(name) + ": got " + std::to_string(got) + ", expected " + std::to_string(expected) +
           ", as many as " + other);
}

std::vector<std::array<std::uint32_t, 3>> read_triangles(nb::handle value, std::size_t vertices) {
  Rows rows("triangles", value, {3}, Rows::Accept::integers);
  expect_list(rows, {3});
  std::vector<std::array<std::uint32_t, 3>> triangles(rows.count());
  // A chunk at a time, so that no second copy of 64 bits is made.
  constexpr std::size_t kChunk = 4096;
  std::vector<std::int64_t> chunk(3 * std::min(kChunk, rows.count()));
  for (std::size_t begin = 0; begin < rows.count(); begin += kChunk) {
    const std::size_t count = std::min(kChunk, rows.count() - begin);
    rows.read(begin, count, chunk.data(), 3);
    for (std::size_t i = 0; i < 3 * count; ++i) {
      if (chunk[i] < 0 || static_cast<std::size_t>(chunk[i]) >= vertices)
        refuse("triangles[" + std::to_string(begin + i / 3) + ", " + std::to_string(i % 3) + "] is " +
               (rows.is_u64() ? std::to_string(static_cast<std::uint64_t>(chunk[i]))
                              : std::to_string(chunk[i])) +
               ", expected " + positions_of(vertices, "vertices"));
      triangles[begin + i / 3][i % 3] = static_cast<std::uint32_t>(chunk[i]);
    }
  }
  return triangles;
}

Affine3 read_transform(const char* name, nb::handle value) {
  if (value.is_none()) return Affine3::identity();
  Rows rows(name, value, {4, 4});
  if (!rows.shape().empty())
    refuse(std::string(name) + ": got an array of shape " + to_string(rows.shape(), {4, 4}) +
           ", expected shape (4, 4)");
  float m[16];
  rows.read(0, 1, m, 16);
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    refuse(std::string(name) + ": the last row is " + number(m[12]) + " " + number(m[13]) + " " +
           number(m[14]) + " " + number(m[15]) + ", expected 0 0 0 1");
  const Affine3 affine{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
  try {
    inverse(affine);
  } catch (const std::invalid_argument&) {
    refuse(std::string(name) +
           ": cannot be inverted, expected a transform of finite numbers that keeps "
           "three dimensions");
  }
  return affine;
}

/// As many radii as there are centers.
std::vector<float> read_radii(nb::handle value, std::size_t centers) {
  const auto radii = read_floats<float>("radii", value, {});
  expect_length("radii", radii.size(), "centers", centers);
  for (std::size_t i = 0; i < radii.size(); ++i)
    if (radii[i] < 0)
      refuse("radii[" + std::to_string(i) + "] is " + number(radii[i]) + ", expected 0 or more");
  return radii;
}

std::vector<Sphere> read_spheres(nb::handle centers, nb::handle radii) {
  const auto c = read_floats<Vec3>("centers", centers, {3});
  const auto r = read_radii(radii, c.size());
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < c.size(); ++i) spheres.push_back(Sphere{c[i], r[i]});
  return spheres;
}

std::vector<Disk> read_disks(nb::handle centers, nb::handle normals, nb::handle radii) {
  const auto c = read_floats<Vec3>("centers", centers, {3});
  const auto n = read_floats<Vec3>("normals", normals, {3});
  const auto r = read_radii(radii, c.size());
  expect_length("normals", n.size(), "centers", c.size());
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < c.size(); ++i) disks.push_back(Disk{c[i], n[i], r[i]});
  return disks;
}

std::vector<Quad> read_quads(nb::handle corners) {
  struct Corners {
    Vec3 p[4];
  };
  const auto c = read_floats<Corners>("corners", corners, {4, 3});
  std::vector<Quad> quads;
  for (const Corners& q : c) quads.push_back(Quad{q.p[0], q.p[1], q.p[2], q.p[3]});
  return quads;
}

std::vector<Cuboid> read_cuboids(nb::handle lower, nb::handle upper) {
  const auto a = read_floats<Vec3>("lower", lower, {3});
  const auto b = read_floats<Vec3>("upper", upper, {3});
  expect_length("upper", b.size(), "lower", a.size());
  std::vector<Cuboid> cuboids;
  for (std::size_t i = 0; i < a.size(); ++i) cuboids.push_back(Cuboid{a[i], b[i]});
  return cuboids;
}

std::size_t add_geometry(SceneDesc& desc, Shapes shapes, const std::string& name) {
  return desc.add(Geometry{std::move(shapes), {}, {}, name}).value;
}

}  // namespace

TriangleMesh read_mesh(nb::handle vertices, nb::handle triangles, nb::handle normals, nb::handle uvs) {
  TriangleMesh mesh;
  mesh.positions = read_floats<Vec3>("vertices", vertices, {3});
  mesh.indices = read_triangles(triangles, mesh.positions.size());
  if (!normals.is_none()) {
    mesh.normals = read_floats<Vec3>("normals", normals, {3});
    expect_length("normals", mesh.normals.size(), "vertices", mesh.positions.size());
  }
  if (!uvs.is_none()) {
    mesh.uvs = read_floats<Vec2>("uvs", uvs, {2});
    expect_length("uvs", mesh.uvs.size(), "vertices", mesh.positions.size());
  }
  return mesh;
}

std::string positions_of(std::size_t count, const char* what) {
  return count > 0 ? "0 to " + std::to_string(count - 1) : std::string("none, since there are no ") + what;
}

std::string summary(const SceneDesc& desc) {
  constexpr const char* kOne[] = {"triangle", "sphere", "quad", "cuboid", "disk", "other shape"};
  std::size_t lists[6] = {}, shapes[6] = {};
  for (const Geometry& geometry : desc.geometries) {
    ++lists[geometry.shapes.index()];
    shapes[geometry.shapes.index()] += primitive_count(geometry);
  }
  std::string text;
  for (std::size_t i = 0; i < 6; ++i) {
    if (lists[i] == 0) continue;
    text += text.empty() ? "" : ", ";
    if (i == 0) text += counted(lists[0], "mesh", "meshes") + " of ";
    text += counted(shapes[i], kOne[i], std::string(kOne[i]) + "s");
  }
  if (text.empty()) return "empty";
  if (!desc.instances.empty()) text += ", " + counted(desc.instances.size(), "instance", "instances");
  return text;
}

nb::list names_of(const SceneDesc& desc) {
  nb::list names;
  for (const Geometry& geometry : desc.geometries) names.append(geometry.name);
  return names;
}

nb::object array_of(const Affine3& m) {
  auto* const values = new double[16]{m.x.x, m.y.x, m.z.x, m.origin.x, m.x.y, m.y.y, m.z.y, m.origin.y,
                                      m.x.z, m.y.z, m.z.z, m.origin.z, 0,     0,     0,     1};
  nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double, nb::shape<4, 4>>(values, {4, 4}, owner));
}

void bind_description(nb::module_& module) {
  using nb::arg;
  using nb::sig;

  nb::enum_<Method>(module, "Method", "How a tree is built.")
      .value("longest_axis", Method::longest_axis, doc::longest_axis)
      .value("binned_sah", Method::binned_sah, doc::binned_sah)
      .value("sweep_sah", Method::sweep_sah, doc::sweep_sah)
      .value("ploc", Method::ploc, doc::ploc);

  nb::class_<BuildOptions> options(module, "BuildOptions", doc::BuildOptions);
  def_pickle(options);
  options.def(nb::init<>())
      .def_rw("method", &BuildOptions::method, "See Method.")
      .def_rw("max_depth", &BuildOptions::max_depth, doc::BuildOptions_max_depth)
      .def_rw("leaf_size", &BuildOptions::leaf_size, doc::BuildOptions_leaf_size)
      .def_rw("block_size", &BuildOptions::block_size, doc::BuildOptions_block_size)
      .def_rw("bins", &BuildOptions::bins, doc::BuildOptions_bins)
      .def_rw("traversal_cost", &BuildOptions::traversal_cost, doc::BuildOptions_traversal_cost)
      .def_rw("reinsertion_rounds", &BuildOptions::reinsertion_rounds, doc::BuildOptions_reinsertion_rounds)
      .def_rw("reinsertion_share", &BuildOptions::reinsertion_share, "The share of all nodes, 0 to 1.")
      .def_rw("split_share", &BuildOptions::split_share, doc::BuildOptions_split_share)
      .def_rw("is_compact", &BuildOptions::is_compact, doc::BuildOptions_is_compact)
      .def_static("fast", &BuildOptions::fast, doc::BuildOptions_fast)
      .def_static("balanced", &BuildOptions::balanced, doc::BuildOptions_balanced)
      .def_static("best", &BuildOptions::best, doc::BuildOptions_best)
      .def("__repr__", [](const BuildOptions& o) {
        constexpr const char* kNames[] = {"longest_axis", "binned_sah", "sweep_sah", "ploc"};
        return std::string("<boxwood.BuildOptions: ") + kNames[static_cast<int>(o.method)] + ", leaves of " +
               std::to_string(o.leaf_size) + ", " + counted(o.reinsertion_rounds, "round", "rounds") +
               " of reinsertion, split_share " + number(o.split_share) + (o.is_compact ? ", compact>" : ">");
      });

  nb::class_<Camera> camera(module, "Camera", doc::Camera);
  def_pickle(camera);
  camera
      .def_prop_ro(
          "world_from_camera", [](const Camera& c) { return array_of(c.world_from_camera); },
          sig("def world_from_camera(self) -> numpy.typing.NDArray[numpy.float64]"),
          "(4, 4): takes camera coordinates to the world.")
      .def_ro("fov_deg", &Camera::fov_deg, doc::Camera_fov_deg)
      .def_ro("orthographic_size", &Camera::orthographic_size, doc::Camera_orthographic_size)
      .def_ro("lens_radius", &Camera::lens_radius, doc::Camera_lens_radius)
      .def_ro("focus_distance", &Camera::focus_distance, doc::Camera_focus_distance)
      .def_ro("width", &Camera::width, doc::Camera_width)
      .def_ro("height", &Camera::height, "As width.");

  nb::class_<SceneDesc> scene_desc(
      module, "SceneDesc",
      "What is in a scene: plain data that Scene builds its trees from. A geometry is defined once and "
      "appears "
      "wherever an\ninstance places it; without any instance, each appears once, where it was defined.");
  def_pickle(scene_desc);
  scene_desc.def(nb::init<>())
      .def_rw("name", &SceneDesc::name, "From the file, or what you like.")
      .def_ro("warnings", &SceneDesc::warnings, doc::SceneDesc_warnings)
      .def_prop_ro(
          "geometry_count", [](const SceneDesc& d) { return d.geometries.size(); },
          "How many have been added.")
      .def_prop_ro(
          "geometry_names", [](const SceneDesc& d) { return names_of(d); },
          sig("def geometry_names(self) -> list[str]"), kGeometryNames)
      .def_prop_ro(
          "instance_count", [](const SceneDesc& d) { return d.instances.size(); },
          "How many have been added; with none, each geometry is shown where it was defined.")
      .def(
          "add_mesh",
          [](SceneDesc& desc, nb::handle vertices, nb::handle triangles, nb::handle normals, nb::handle uvs,
             const std::string& name) {
            return add_geometry(desc, read_mesh(vertices, triangles, normals, uvs), name);
          },
          arg("vertices").none(), arg("triangles").none(), nb::kw_only(), arg("normals") = nb::none(),
          arg("uvs") = nb::none(), arg("name") = "",
          sig("def add_mesh(self, vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, *, "
              "normals: numpy.typing.ArrayLike | None = None, uvs: numpy.typing.ArrayLike | None = None, "
              "name: str = '') -> int"),
          "Triangles that share vertices: (n, 3) numbers and (m, 3) indices, perhaps with shading normals "
          "(n, 3) "
          "and texture\ncoordinates (n, 2). Returns the geometry's id. Raises ValueError and TypeError that "
          "name "
          "the argument and the place.")
      .def(
          "add_spheres",
          [](SceneDesc& desc, nb::handle centers, nb::handle radii, const std::string& name) {
            return add_geometry(desc, read_spheres(centers, radii), name);
          },
          arg("centers").none(), arg("radii").none(), nb::kw_only(), arg("name") = "",
          sig("def add_spheres(self, centers: numpy.typing.ArrayLike, radii: numpy.typing.ArrayLike, *, "
              "name: "
              "str = '') -> int"),
          "Spheres: centers (n, 3), radii (n,). Returns the geometry's id.")
      .def(
          "add_quads",
          [](SceneDesc& desc, nb::handle corners, const std::string& name) {
            return add_geometry(desc, read_quads(corners), name);
          },
          arg("corners").none(), nb::kw_only(), arg("name") = "",
          sig("def add_quads(self, corners: numpy.typing.ArrayLike, *, name: str = '') -> int"),
          "Quadrilaterals: corners (n, 4, 3), in order around each. Returns the geometry's id.")
      .def(
          "add_cuboids",
          [](SceneDesc& desc, nb::handle lower, nb::handle upper, const std::string& name) {
            return add_geometry(desc, read_cuboids(lower, upper), name);
          },
          arg("lower").none(), arg("upper").none(), nb::kw_only(), arg("name") = "",
          sig("def add_cuboids(self, lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, *, name: "
              "str = "
              "'') -> int"),
          "Boxes along the axes: their corners (n, 3). Returns the geometry's id.")
      .def(
          "add_disks",
          [](SceneDesc& desc, nb::handle centers, nb::handle normals, nb::handle radii,
             const std::string& name) {
            return add_geometry(desc, read_disks(centers, normals, radii), name);
          },
          arg("centers").none(), arg("normals").none(), arg("radii").none(), nb::kw_only(), arg("name") = "",
          sig("def add_disks(self, centers: numpy.typing.ArrayLike, normals: numpy.typing.ArrayLike, radii: "
              "numpy.typing.ArrayLike, *, name: str = '') -> int"),
          "Disks: centers (n, 3), normals (n, 3) of any length, radii (n,). Returns the geometry's id.")
      .def(
          "add_instance",
          [](SceneDesc& desc, nb::handle geometry, nb::handle world_from_object) {
            const long long id = read_integer("geometry", geometry);
            if (id < 0 || static_cast<std::size_t>(id) >= desc.geometries.size())
              refuse("geometry: got " + repr_of(geometry) + ", expected " +
                     positions_of(desc.geometries.size(), "geometries"));
            return desc
                .add(Instance{GeometryId(static_cast<std::uint32_t>(id)),
                              read_transform("world_from_object", world_from_object),
                              {}})
                .value;
          },
          arg("geometry").none(), arg("world_from_object") = nb::none(),
          sig("def add_instance(self, geometry: int, world_from_object: numpy.typing.ArrayLike | None = "
              "None) -> "
              "int"),
          "Places a geometry, by a (4, 4) transform: world = m @ (x, y, z, 1); None leaves it where it was "
          "defined.\nReturns the instance's id.")
      .def("__repr__", [](const SceneDesc& d) { return "<boxwood.SceneDesc: " + summary(d) + ">"; });
}

}  // namespace boxwood::python
