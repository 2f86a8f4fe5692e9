#include "scene_type.h"

#include <filesystem>

#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "boxwood/gallery/gallery.h"
#include "boxwood/io/load.h"
#include "boxwood/scene/parts.h"
#include "docstrings.h"
#include "pickles.h"
#include "queries.h"

namespace boxwood::python {
namespace {

constexpr std::size_t kLongBuild = 20'000;  // primitives: some ten milliseconds

/// Replaces what is no UTF-8: the names in a file may be of any encoding, and Python takes only text.
void make_text(std::string& name) {
  const auto text =
      nb::steal<nb::str>(PyUnicode_DecodeUTF8(name.data(), static_cast<Py_ssize_t>(name.size()), "replace"));
  if (!text.is_valid()) nb::raise_python_error();
  name = text.c_str();
}

/// What queries need; materials and lights say how things look, which none asks.
SceneDesc without_looks(SceneDesc desc) {
  for (Geometry& geometry : desc.geometries) {
    geometry.material = {};
    geometry.materials = {};
    make_text(geometry.name);
    if (auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
      mesh->second_uvs = {};
      mesh->colors = {};
    }
  }
  for (Instance& instance : desc.instances) instance.material = {};
  SceneDesc kept;
  kept.geometries = std::move(desc.geometries);
  kept.instances = std::move(desc.instances);
  kept.camera = desc.camera;
  kept.name = std::move(desc.name);
  kept.warnings = std::move(desc.warnings);
  make_text(kept.name);
  for (std::string& warning : kept.warnings) make_text(warning);
  return kept;
}

SceneDesc read_desc(const std::filesystem::path& path, nb::handle threads) {
  Executor& executor = executor_of(threads);
  const std::string name = path.string();
  const bool is_made = gallery::is_known(name.substr(0, name.find(':')));
  std::error_code hidden;
  if (!is_made && !std::filesystem::exists(path, hidden) && !hidden) {
    const nb::object shown = nb::steal(PyUnicode_DecodeFSDefault(name.c_str()));
    PyErr_SetObject(
        PyExc_FileNotFoundError,
        nb::make_tuple(ENOENT, "there is no such file, and no made scene of that name", shown).ptr());
    nb::raise_python_error();
  }
  SceneDesc desc;
  run_interruptibly(
      true, [&](const Progress&) { desc = is_made ? gallery::make(name) : io::load(path, &executor); });
  return without_looks(std::move(desc));
}

BuildOptions or_default(const std::optional<BuildOptions>& options) {
  return options ? *options : BuildOptions::balanced();
}

/// A read-only array over memory that `owner` keeps.
template <class T>
nb::object view_of(const T* data, std::initializer_list<std::size_t> shape, nb::handle owner) {
  return nb::cast(nb::ndarray<nb::numpy, const T>(data, shape.size(), shape.begin(), owner));
}

/// The position of one among `count`. Throws IndexError, TypeError.
std::size_t read_id(const char* name, nb::handle value, std::size_t count, const char* what) {
  const long long id = read_integer(name, value);
  if (id < 0 || static_cast<std::size_t>(id) >= count)
    throw nb::index_error(
        (std::string(name) + ": got " + repr_of(value) + ", expected " + positions_of(count, what)).c_str());
  return static_cast<std::size_t>(id);
}

}  // namespace

SceneObject build_scene(SceneDesc desc, BuildOptions options, nb::handle threads) {
  options.executor = &executor_of(threads);
  std::optional<Scene> scene;
  const bool is_long = defined_primitive_count(desc) > kLongBuild;
  run_interruptibly(is_long, [&](const Progress& progress) {
    BuildOptions watched = options;
    watched.progress = progress;
    scene.emplace(std::move(desc), watched);
  });
  options.executor = nullptr;
  return {std::move(*scene), options};
}

void bind_scene(nb::module_& module) {
  using nb::arg;
  using nb::sig;

  nb::class_<SceneObject> scene(module, "Scene", nb::is_weak_referenceable(),
                                "Geometry with its trees: built once, read-only from then on; any number of "
                                "threads may ask. Questions take arrays of\nany float or integer type, any "
                                "strides and any leading shape, and answer in that shape.");
  scene
      .def(
          "__init__",
          [](SceneObject* self, const SceneDesc& desc, const std::optional<BuildOptions>& options,
             nb::handle threads) { new (self) SceneObject(build_scene(desc, or_default(options), threads)); },
          arg("desc"), arg("options") = nb::none(), nb::kw_only(), arg("threads").none() = 0,
          (std::string(doc::Scene_Scene) + "\nCtrl-C ends a long build. threads = 0 means all.").c_str())
      .def_static(
          "from_mesh",
          [](nb::handle vertices, nb::handle triangles, nb::handle normals,
             const std::optional<BuildOptions>& options, nb::handle threads) {
            SceneDesc desc;
            desc.add(read_mesh(vertices, triangles, normals, nb::none()));
            return build_scene(std::move(desc), or_default(options), threads);
          },
          arg("vertices").none(), arg("triangles").none(), nb::kw_only(), arg("normals") = nb::none(),
          arg("options") = nb::none(), arg("threads").none() = 0,
          sig("def from_mesh(vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, *, "
              "normals: "
              "numpy.typing.ArrayLike | None = None, options: BuildOptions | None = None, threads: int = 0) "
              "-> "
              "Scene"),
          "A scene of one mesh: (n, 3) vertices, (m, 3) indices, perhaps shading normals (n, 3).\nRaises "
          "ValueError and TypeError that name the argument and the place. Ctrl-C ends a long build.")
      .def(
          "stats",
          [](const SceneObject& s) {
            const SceneStatistics statistics = s.scene.statistics();
            nb::dict figures;
            figures["primitives"] = statistics.primitives;
            figures["trees"] = statistics.trees;
            figures["nodes"] = statistics.nodes;
            figures["tree_bytes"] = statistics.tree_bytes;
            figures["geometry_bytes"] = statistics.geometry_bytes;
            figures["build_ms"] = statistics.build_ms;
            return figures;
          },
          sig("def stats(self) -> dict[str, float]"), doc::SceneStatistics)
      .def_prop_ro(
          "bounds",
          [](const SceneObject& s) {
            const Box3 box = s.scene.bounds();
            auto* const corners =
                new float[6]{box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
            nb::capsule owner(corners, [](void* p) noexcept { delete[] static_cast<float*>(p); });
            return nb::cast(nb::ndarray<nb::numpy, float, nb::shape<2, 3>>(corners, {2, 3}, owner));
          },
          sig("def bounds(self) -> numpy.typing.NDArray[numpy.float32]"),
          "(2, 3): the lower and the upper corner; of an empty scene inf and -inf.")
      .def_prop_ro(
          "geometry_count", [](const SceneObject& s) { return s.scene.description().geometries.size(); },
          "How many geometry_ids there are.")
      .def_prop_ro(
          "instance_count", [](const SceneObject& s) { return s.scene.parts().instances.size(); },
          "How many instance_ids there are.")
      .def_prop_ro(
          "geometry_names", [](const SceneObject& s) { return names_of(s.scene.description()); },
          sig("def geometry_names(self) -> list[str]"), kGeometryNames)
      .def_prop_ro(
          "name", [](const SceneObject& s) { return s.scene.description().name; }, "From the file, or empty.")
      .def_prop_ro(
          "warnings", [](const SceneObject& s) { return s.scene.description().warnings; },
          doc::SceneDesc_warnings)
      .def_prop_ro(
          "camera", [](const SceneObject& s) { return s.scene.description().camera; },
          "From the file; None when it has none.")
      .def_prop_ro(
          "options", [](const SceneObject& s) { return s.options; }, "How it was built.")
      .def(
          "mesh",
          [](nb::handle_t<SceneObject> self, nb::handle geometry_id) {
            const auto& geometries = nb::cast<SceneObject&>(self).scene.description().geometries;
            const std::size_t id = read_id("geometry_id", geometry_id, geometries.size(), "geometries");
            const auto* mesh = std::get_if<TriangleMesh>(&geometries[id].shapes);
            if (!mesh) throw nb::type_error(("geometry " + std::to_string(id) + " is not a mesh").c_str());
            return nb::make_tuple(view_of(reinterpret_cast<const float*>(mesh->positions.data()),
                                          {mesh->positions.size(), 3}, self),
                                  view_of(reinterpret_cast<const std::uint32_t*>(mesh->indices.data()),
                                          {mesh->indices.size(), 3}, self));
          },
          arg("geometry_id").none() = 0,
          sig("def mesh(self, geometry_id: int = 0) -> tuple[numpy.typing.NDArray[numpy.float32], "
              "numpy.typing.NDArray[numpy.uint32]]"),
          "The vertices (n, 3) and triangles (m, 3) of a mesh where it was defined; read-only, not copied.")
      .def(
          "instance",
          [](const SceneObject& s, nb::handle instance_id) {
            const auto& instances = s.scene.parts().instances;
            const Instance& instance =
                instances[read_id("instance_id", instance_id, instances.size(), "instances")];
            return nb::make_tuple(instance.geometry.value, array_of(instance.world_from_object));
          },
          arg("instance_id").none(),
          sig("def instance(self, instance_id: int) -> tuple[int, numpy.typing.NDArray[numpy.float64]]"),
          "The geometry_id of an instance, and its (4, 4) transform.")
      .def("__repr__", [](const SceneObject& s) {
        const SceneDesc& desc = s.scene.description();
        return "<boxwood.Scene" + (desc.name.empty() ? "" : " '" + desc.name + "'") + ": " + summary(desc) +
               ">";
      });
  def_pickle(scene);
  bind_queries(scene);

  module.def(
      "load",
      [](const std::filesystem::path& path, const std::optional<BuildOptions>& options, nb::handle threads) {
        return build_scene(read_desc(path, threads), or_default(options), threads);
      },
      arg("path"), arg("options") = nb::none(), nb::kw_only(), arg("threads").none() = 0,
      sig("def load(path: str | os.PathLike[str], options: BuildOptions | None = None, *, threads: int = 0) "
          "-> "
          "Scene"),
      "Reads a scene file (.obj .ply .stl .gltf .glb .pbrt) and builds it; or makes a scene of the gallery, "
      "such "
      "as \"stilllife\" or\n\"terrain:512\". Materials, textures and lights, which no query needs, are left "
      "out. "
      "Raises FileNotFoundError, FileError.");
  module.def("load_description", &read_desc, arg("path"), nb::kw_only(), arg("threads").none() = 0,
             sig("def load_description(path: str | os.PathLike[str], *, threads: int = 0) -> SceneDesc"),
             "As load, but does not build: more may be added.");
}

}  // namespace boxwood::python
