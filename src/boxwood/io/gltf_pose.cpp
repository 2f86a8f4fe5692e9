#include "boxwood/io/gltf_pose.h"

#include <algorithm>
#include <stdexcept>

#include <tiny_gltf.h>

#include "boxwood/io/gltf_accessor.h"

namespace boxwood::io::gltf {
namespace {

std::string place_of(std::size_t mesh, std::size_t primitive) {
  return "mesh " + std::to_string(mesh) + ", primitive " + std::to_string(primitive);
}

/// The accessor of an attribute, or -1.
int attribute(const std::map<std::string, int>& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found != attributes.end() ? found->second : -1;
}

void check_count(const File& file, std::size_t count, std::size_t vertices, const std::string& where) {
  if (count != vertices)
    file.fail(where, "there are " + std::to_string(count) + " elements, expected one for each of the " +
                         std::to_string(vertices) + " positions");
}

void add_scaled(std::vector<Affine3>& sums, std::size_t i, const Affine3& m, float weight) {
  sums[i].x += m.x * weight;
  sums[i].y += m.y * weight;
  sums[i].z += m.z * weight;
  sums[i].origin += m.origin * weight;
}

}  // namespace

std::vector<float> morph_weights(const File& file, int node) {
  const tinygltf::Node& source = file.model->nodes[node];
  const std::vector<double>& numbers =
      !source.weights.empty() ? source.weights : file.model->meshes[source.mesh].weights;
  std::vector<float> weights(numbers.begin(), numbers.end());
  if (std::all_of(weights.begin(), weights.end(), [](float weight) { return weight == 0; })) weights.clear();
  return weights;
}

void morph(const File& file, std::size_t mesh, std::size_t primitive, std::span<const float> weights,
           TriangleMesh& vertices) {
  const auto& targets = file.model->meshes[mesh].primitives[primitive].targets;
  for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
    const auto move = [&](std::vector<Vec3>& moved, const std::string& name) {
      const int accessor = attribute(targets[t], name);
      if (accessor == -1 || moved.empty() || weights[t] == 0) return;
      const std::string where = place_of(mesh, primitive) + ", target " + std::to_string(t) + ", " + name;
      const std::vector<Vec3> by = read_vec3(file, accessor, where);
      check_count(file, by.size(), moved.size(), where);
      for (std::size_t i = 0; i < by.size(); ++i) moved[i] += by[i] * weights[t];
    };
    move(vertices.positions, "POSITION");
    move(vertices.normals, "NORMAL");
  }
}

std::optional<std::vector<Affine3>> joint_transforms(
    const File& file, int index, std::span<const std::optional<Affine3>> world_from_node) {
  const std::string where = "skin " + std::to_string(index);
  if (index < 0 || std::size_t(index) >= file.model->skins.size())
    file.fail(where, "the skin does not exist, there are " + std::to_string(file.model->skins.size()));
  const tinygltf::Skin& skin = file.model->skins[index];
  std::vector<Affine3> joint_from_mesh(skin.joints.size());
  if (skin.inverseBindMatrices != -1) {
    joint_from_mesh = read_affine(file, skin.inverseBindMatrices, where + ", inverseBindMatrices");
    if (joint_from_mesh.size() < skin.joints.size())
      file.fail(where, "there are " + std::to_string(joint_from_mesh.size()) + " inverseBindMatrices for " +
                           std::to_string(skin.joints.size()) + " joints");
  }
  std::vector<Affine3> transforms(skin.joints.size());
  for (std::size_t j = 0; j < transforms.size(); ++j) {
    const int joint = skin.joints[j];
    if (joint < 0 || std::size_t(joint) >= world_from_node.size())
      file.fail(where, "joint " + std::to_string(j) + " is node " + std::to_string(joint) +
                           ", which does not exist, there are " + std::to_string(world_from_node.size()));
    if (!world_from_node[joint]) return std::nullopt;
    transforms[j] = *world_from_node[joint] * joint_from_mesh[j];
  }
  return transforms;
}

void bend(const File& file, std::size_t mesh, std::size_t primitive, std::span<const Affine3> joints,
          TriangleMesh& vertices) {
  // The mean of each vertex's transforms.
  const auto& attributes = file.model->meshes[mesh].primitives[primitive].attributes;
  const std::size_t count = vertices.positions.size();
  std::vector<Affine3> means(count, Affine3{{}, {}, {}, {}});
  std::vector<float> shares(count);
  for (int set = 0;; ++set) {
    const std::string number = std::to_string(set);
    const int which = attribute(attributes, "JOINTS_" + number),
              how_much = attribute(attributes, "WEIGHTS_" + number);
    if (which == -1 || how_much == -1) break;
    const std::string where = place_of(mesh, primitive) + ", JOINTS_" + number;
    const auto ids = read_vec4(file, which, where),
               weights = read_vec4(file, how_much, place_of(mesh, primitive) + ", WEIGHTS_" + number);
    check_count(file, ids.size(), count, where);
    check_count(file, weights.size(), count, where);
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < 4; ++k) {
        if (weights[i][k] == 0) continue;
        if (!(ids[i][k] >= 0 && ids[i][k] < static_cast<float>(joints.size())))
          file.fail(where, "vertex " + std::to_string(i) + " hangs on joint " + std::to_string(ids[i][k]) +
                               ", but the skin has " + std::to_string(joints.size()));
        add_scaled(means, i, joints[static_cast<std::size_t>(ids[i][k])], weights[i][k]);
        shares[i] += weights[i][k];
      }
  }

  for (std::size_t i = 0; i < count; ++i) {
    // What hangs on nothing hangs on the first joint.
    Affine3 world_from_mesh = joints.empty() ? Affine3::identity() : joints[0];
    if (shares[i] > 0) {
      const float part = 1 / shares[i];
      world_from_mesh = {means[i].x * part, means[i].y * part, means[i].z * part, means[i].origin * part};
    }
    vertices.positions[i] = world_from_mesh.point(vertices.positions[i]);
    if (vertices.normals.empty()) continue;
    // The cofactors turn normals as the inverse would, and are there where it is not.
    const Affine3& m = world_from_mesh;
    const Affine3 cofactors{cross(m.y, m.z), cross(m.z, m.x), cross(m.x, m.y), {}};
    const Vec3 normal = normalize(cofactors.vector(vertices.normals[i]));
    vertices.normals[i] = is_finite(normal) ? normal : Vec3{0, 0, 0};
  }
}

}  // namespace boxwood::io::gltf
