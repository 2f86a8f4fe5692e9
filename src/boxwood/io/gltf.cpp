// gltf.cpp: how does a glTF or GLB file, version 2.0, become a scene?
//
// The nodes of the default scene form trees of transforms; each place where a mesh hangs becomes one Instance
// per primitive of the mesh, and the primitive one Geometry however many nodes share it. A mesh that hangs in
// one place is put there: triangles of the world are asked faster than those below a transform. See the glTF
// 2.0 specification, sections 3.5 and 3.7.

#include <cmath>
#include <stdexcept>

#include <tiny_gltf.h>

#include "boxwood/io/formats.h"
#include "boxwood/io/gltf_accessor.h"
#include "boxwood/io/gltf_material.h"
#include "boxwood/io/gltf_mesh.h"
#include "boxwood/io/gltf_pose.h"
#include "boxwood/io/gltf_value.h"

namespace boxwood::io {
namespace gltf {
namespace {

// Each node has its own copy of what it bends, and a few bytes make a node.
constexpr std::size_t kMostPosed = std::size_t(1) << 23, kMostCopies = std::size_t(1) << 22;
constexpr double kDegrees = 180 / 3.14159265358979323846;

class Builder {
 public:
  Builder(const File& file, Executor& executor) : file_(file), model_(*file.model) {
    add_materials(file, executor, desc_);
    geometries_.resize(model_.meshes.size());
  }

  SceneDesc run() {
    // Walk the trees depth first, children in order; a stack, since a file may chain nodes without end.
    struct Visit {
      int node;
      Affine3 world_from_parent;
    };
    std::vector<Visit> stack;
    const std::vector<int> roots = root_nodes();
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}});
    world_from_node_.resize(model_.nodes.size());
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const std::string where = "node " + std::to_string(visit.node);
      if (visit.node < 0 || std::size_t(visit.node) >= model_.nodes.size())
        file_.fail(where, "the node does not exist, there are " + std::to_string(model_.nodes.size()));
      if (world_from_node_[visit.node])
        file_.fail(where, "the node is reached twice, but the nodes must form trees");

      const tinygltf::Node& node = model_.nodes[visit.node];
      const Affine3 world_from_node = visit.world_from_parent * local_transform(node, where);
      if (!is_finite(world_from_node.x) || !is_finite(world_from_node.y) || !is_finite(world_from_node.z) ||
          !is_finite(world_from_node.origin))
        file_.fail(where, "the transform is not finite");
      world_from_node_[visit.node] = world_from_node;
      if (node.mesh != -1) place_mesh(visit.node, where);
      if (node.camera != -1) add_camera(node.camera, world_from_node, where);
      add_light(node, world_from_node, where);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        stack.push_back({*child, world_from_node});
    }
    place_posed_meshes();
    if (!model_.animations.empty())
      warn(desc_.warnings, file_, "",
           "animations are not supported; all stands as in the file's pose at rest");
    put_in_place();
    return std::move(desc_);
  }

 private:
  /// The nodes on top: those of the default scene, of the first scene,
  /// or all without a parent when there is no scene.
  std::vector<int> root_nodes() const {
    if (!model_.scenes.empty()) {
      const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
      if (std::size_t(scene) >= model_.scenes.size())
        file_.fail("scene", "scene " + std::to_string(scene) + " does not exist, there are " +
                                std::to_string(model_.scenes.size()));
      return model_.scenes[scene].nodes;
    }
    std::vector<bool> has_parent(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children)
        if (child >= 0 && std::size_t(child) < has_parent.size()) has_parent[child] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < has_parent.size(); ++i)
      if (!has_parent[i]) roots.push_back(static_cast<int>(i));
    return roots;
  }

  Affine3 local_transform(const tinygltf::Node& node, const std::string& where) const {
    const auto check_length = [&](const std::vector<double>& numbers, std::size_t expected,
                                  const char* name) {
      if (!numbers.empty() && numbers.size() != expected)
        file_.fail(where, std::string(name) + " has " + std::to_string(numbers.size()) +
                              " numbers, expected " + std::to_string(expected));
      return !numbers.empty();
    };
    if (check_length(node.matrix, 16, "matrix")) {
      const std::vector<double>& m = node.matrix;  // column by column
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
        file_.fail(where, "the matrix is not affine: its last row is not 0 0 0 1");
      const auto column = [&](int k) { return Vec3{float(m[k]), float(m[k + 1]), float(m[k + 2])}; };
      return {column(0), column(4), column(8), column(12)};
    }

    Affine3 local;
    if (check_length(node.rotation, 4, "rotation")) local = rotation(node.rotation, where);
    if (check_length(node.scale, 3, "scale")) {
      local.x *= float(node.scale[0]);
      local.y *= float(node.scale[1]);
      local.z *= float(node.scale[2]);
    }
    if (check_length(node.translation, 3, "translation"))
      local.origin = {float(node.translation[0]), float(node.translation[1]), float(node.translation[2])};
    return local;
  }

  /// The matrix of a quaternion (x, y, z, w) of any length but 0.
  Affine3 rotation(const std::vector<double>& q, const std::string& where) const {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double s = 2 / (x * x + y * y + z * z + w * w);
    if (!std::isfinite(s)) file_.fail(where, "the rotation is a quaternion of no length");
    const auto column = [](double a, double b, double c) { return Vec3{float(a), float(b), float(c)}; };
    Affine3 out;
    out.x = column(1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w));
    out.y = column(s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w));
    out.z = column(s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y));
    return out;
  }

  void place_mesh(int index, const std::string& where) {
    const tinygltf::Node& node = model_.nodes[index];
    if (node.mesh < 0 || std::size_t(node.mesh) >= model_.meshes.size())
      file_.fail(where, "mesh " + std::to_string(node.mesh) + " does not exist, there are " +
                            std::to_string(model_.meshes.size()));
    if (node.skin != -1 || !morph_weights(file_, index).empty()) {
      posed_.push_back(index);  // joints may stand further on
      return;
    }

    // Read the mesh when it is first needed.
    std::optional<std::vector<GeometryId>>& ids = geometries_[node.mesh];
    if (!ids) {
      ids.emplace();
      for (std::size_t p = 0; p < model_.meshes[node.mesh].primitives.size(); ++p)
        if (std::optional<Geometry> geometry = read_primitive(file_, node.mesh, p, desc_.warnings))
          ids->push_back(desc_.add(std::move(*geometry)));
    }
    for (const Affine3& node_from_copy : copies(node, where))
      for (const GeometryId id : *ids) place(id, *world_from_node_[index] * node_from_copy, where);
  }

  /// Where a node's mesh stands below the node: once, unless EXT_mesh_gpu_instancing repeats it.
  std::vector<Affine3> copies(const tinygltf::Node& node, const std::string& where) {
    const tinygltf::Value* instancing = extension(node.extensions, "EXT_mesh_gpu_instancing");
    if (instancing == nullptr) return {Affine3::identity()};
    std::vector<Affine3> places;
    const auto read = [&](const char* name, const auto& read_vectors, const auto& apply) {
      const int accessor = whole_number(member(instancing, "attributes"), name, -1);
      if (accessor == -1) return;
      const auto vectors = read_vectors(file_, accessor, where + ", " + name);
      if (places.empty()) places.resize(vectors.size());
      if (vectors.size() != places.size())
        file_.fail(where, std::string(name) + " has " + std::to_string(vectors.size()) +
                              " elements, expected one for each of the " + std::to_string(places.size()) +
                              " copies of the mesh");
      for (std::size_t i = 0; i < places.size(); ++i) apply(places[i], vectors[i]);
    };
    // Turned, then scaled along its own axes, then moved.
    read("ROTATION", read_vec4, [&](Affine3& m, const std::array<float, 4>& q) {
      m = rotation({q[0], q[1], q[2], q[3]}, where);
    });
    read("SCALE", read_vec3, [](Affine3& m, Vec3 by) { m = {m.x * by.x, m.y * by.y, m.z * by.z, {}}; });
    read("TRANSLATION", read_vec3, [](Affine3& m, Vec3 by) { m.origin = by; });
    copy_count_ += places.size();
    if (copy_count_ > kMostCopies)
      file_.fail(where, "there are more than " + std::to_string(kMostCopies) + " copies of meshes");
    return places;
  }

  void place(GeometryId id, const Affine3& world_from_object, const std::string& where) {
    try {
      (void)inverse(world_from_object);
    } catch (const std::invalid_argument&) {  // animators hide things by scaling them to nothing
      warn(desc_.warnings, file_, where, "the transform flattens its mesh to nothing; it is left out");
      return;
    }
    desc_.add(Instance{id, world_from_object, {}});
  }

  /// Meshes whose form depends on their node.
  void place_posed_meshes() {
    std::size_t left = kMostPosed;
    for (const int index : posed_) {
      const tinygltf::Node& node = model_.nodes[index];
      const std::string where = "node " + std::to_string(index);
      const std::vector<float> weights = morph_weights(file_, index);
      std::optional<std::vector<Affine3>> joints;
      if (node.skin != -1) {
        joints = joint_transforms(file_, node.skin, world_from_node_);
        if (!joints)
          warn(desc_.warnings, file_, where,
               "a joint of its skin is not in the scene; the mesh has its plain form");
      }
      // Joints take it to the world; where the node stands does not count.
      std::vector<Affine3> places{Affine3::identity()};
      if (!joints) {
        places = copies(node, where);
        for (Affine3& place : places) place = *world_from_node_[index] * place;
      }
      for (std::size_t p = 0; p < model_.meshes[node.mesh].primitives.size(); ++p) {
        std::optional<Geometry> geometry = read_primitive(file_, node.mesh, p, desc_.warnings);
        if (!geometry) continue;
        auto& mesh = std::get<TriangleMesh>(geometry->shapes);
        if (mesh.positions.size() > left)
          file_.fail(where, "the meshes with skins and morph targets have more than " +
                                std::to_string(kMostPosed) + " vertices");
        left -= mesh.positions.size();
        morph(file_, node.mesh, p, weights, mesh);
        if (joints) bend(file_, node.mesh, p, *joints, mesh);
        const GeometryId id = desc_.add(std::move(*geometry));
        for (const Affine3& place_of_copy : places) place(id, place_of_copy, where);
      }
    }
  }

  /// Moves meshes that have one instance to where it shows them.
  void put_in_place() {
    std::vector<int> use_count(desc_.geometries.size());
    for (const Instance& instance : desc_.instances) ++use_count[instance.geometry.value];
    for (Instance& instance : desc_.instances) {
      auto* mesh = std::get_if<TriangleMesh>(&desc_.geometries[instance.geometry.value].shapes);
      if (!mesh || use_count[instance.geometry.value] != 1 ||
          instance.world_from_object == Affine3::identity())
        continue;
      if (std::optional<TriangleMesh> placed = placed_mesh(*mesh, instance.world_from_object)) {
        *mesh = std::move(*placed);
        instance.world_from_object = Affine3::identity();
      }
    }
  }

  /// The mesh in the world. None where that is another mesh: mirrored, so that front sides are back sides, or
  /// so far away that floats are too coarse for it there.
  static std::optional<TriangleMesh> placed_mesh(const TriangleMesh& mesh, const Affine3& world_from_object) {
    constexpr float kFarthest = 1024;  // in extents of the mesh: rounds positions by less than 1e-4 of it
    const Affine3& m = world_from_object;
    if (!(determinant(m) > 0)) return {};
    TriangleMesh placed = mesh;
    Box3 box;
    for (Vec3& position : placed.positions) {
      position = m.point(position);
      if (!is_finite(position)) return {};
      box.extend(position);
    }
    const float reach = max(max_component(abs(box.lower)), max_component(abs(box.upper)));
    if (!(reach <= kFarthest * max_component(box.extent()))) return {};
    const Affine3 object_from_world = inverse(m);
    for (Vec3& normal : placed.normals)
      if (const Vec3 n = transform_normal(object_from_world, normal); length(n) > 0) normal = normalize(n);
    return placed;
  }

  void set_perspective(const tinygltf::PerspectiveCamera& lens, const std::string& where,
                       Camera& camera) const {
    if (!(lens.yfov > 0 && lens.yfov * kDegrees < 180))
      file_.fail(where,
                 "yfov is " + std::to_string(lens.yfov) + " radians, expected more than 0 and less than pi");
    camera.fov_deg = static_cast<float>(lens.yfov * kDegrees);
    if (lens.aspectRatio > 0 && lens.aspectRatio < 1)  // upright: the shorter side is the width
      camera.fov_deg =
          static_cast<float>(2 * std::atan(std::tan(lens.yfov / 2) * lens.aspectRatio) * kDegrees);
  }

  void set_orthographic(const tinygltf::OrthographicCamera& lens, const std::string& where,
                        Camera& camera) const {
    const double half = std::fmin(std::fabs(lens.xmag), std::fabs(lens.ymag));
    camera.orthographic_size = static_cast<float>(2 * half);
    if (!(camera.orthographic_size > 0 && camera.orthographic_size < kInfinity))
      file_.fail(where, "xmag and ymag are " + std::to_string(lens.xmag) + " and " +
                            std::to_string(lens.ymag) + ", expected other numbers than 0");
  }

  /// The first camera of the scene becomes ours.
  void add_camera(int index, const Affine3& world_from_node, const std::string& where) {
    if (index < 0 || std::size_t(index) >= model_.cameras.size())
      file_.fail(where, "camera " + std::to_string(index) + " does not exist, there are " +
                            std::to_string(model_.cameras.size()));
    const tinygltf::Camera& source = model_.cameras[index];
    if (desc_.camera) return;
    Camera camera;
    if (source.type == "orthographic")
      set_orthographic(source.orthographic, "camera " + std::to_string(index), camera);
    else
      set_perspective(source.perspective, "camera " + std::to_string(index), camera);

    // Both conventions look along -z with +y up; the scale of nodes does not count for cameras.
    const Vec3 backward = normalize(world_from_node.z);
    const Vec3 right = normalize(cross(world_from_node.y, backward));
    camera.world_from_camera = {right, cross(backward, right), backward, world_from_node.origin};
    if (!is_finite(right) || !is_finite(backward)) {
      warn(desc_.warnings, file_, where, "the camera's transform flattens space; the camera is left out");
      return;
    }
    desc_.camera = camera;
  }

  /// KHR_lights_punctual; its units, candela and lux, are taken for radiometric ones of the same number.
  void add_light(const tinygltf::Node& node, const Affine3& world_from_node, const std::string& where) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.IsObject() || !found->second.Has("light")) return;
    const tinygltf::Value& value = found->second.Get(std::string("light"));
    const int index = value.IsInt() ? value.GetNumberAsInt() : -1;
    if (index < 0 || std::size_t(index) >= model_.lights.size())
      file_.fail(where, "light " + std::to_string(index) + " does not exist, there are " +
                            std::to_string(model_.lights.size()));
    const tinygltf::Light& light = model_.lights[index];
    Vec3 color{1, 1, 1};
    if (light.color.size() == 3)
      color = {float(light.color[0]), float(light.color[1]), float(light.color[2])};
    color *= float(light.intensity);
    if (!is_finite(color) || min_component(color) < 0)
      file_.fail("light " + std::to_string(index), "the intensity is not a finite color of at least 0");
    if (light.type == "point") {
      desc_.point_lights.push_back({world_from_node.origin, color});
    } else if (const Vec3 along = normalize(-world_from_node.z);
               light.type == "directional" && is_finite(along)) {
      desc_.distant_lights.push_back({along, color});
    } else if (light.type == "spot" && is_finite(along)) {
      const double outer = light.spot.outerConeAngle, inner = light.spot.innerConeAngle;
      if (!(inner >= 0 && inner < outer && outer <= 1.5707964))
        file_.fail("light " + std::to_string(index), "its cone goes from " + std::to_string(inner) + " to " +
                                                         std::to_string(outer) +
                                                         " radians, expected 0 <= inner < outer <= pi / 2");
      desc_.spot_lights.push_back(
          {world_from_node.origin, along, color, float(std::cos(inner)), float(std::cos(outer))});
    } else {
      warn(desc_.warnings, file_, "light " + std::to_string(index),
           "lights of the kind '" + light.type.substr(0, 20) + "' are not supported and left out");
    }
  }

  const File& file_;
  const tinygltf::Model& model_;
  SceneDesc desc_;
  std::vector<std::optional<Affine3>> world_from_node_;  // of those that are in the scene
  std::size_t copy_count_ = 0;
  std::vector<int> posed_;  // nodes whose mesh has a form of its own there
  // By mesh: its primitives, once it was needed.
  std::vector<std::optional<std::vector<GeometryId>>> geometries_;
};

}  // namespace
}  // namespace gltf

SceneDesc load_gltf(const std::filesystem::path& path, Executor& executor) {
  std::vector<std::string> warnings;
  const gltf::File file = gltf::read_model(path, warnings);
  SceneDesc desc = gltf::Builder(file, executor).run();
  desc.warnings.insert(desc.warnings.begin(), warnings.begin(), warnings.end());
  return desc;
}

}  // namespace boxwood::io
