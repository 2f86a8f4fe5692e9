#include "boxwood/scene/description.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <stdexcept>

namespace boxwood {
namespace {

constexpr float kMaxCoordinate = 0x1p126f;

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument("scene: " + what);
}

std::string show(Vec3 p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
}

bool is_usable(Vec3 p) {
  return is_finite(p) && max_component(abs(p)) <= kMaxCoordinate;
}

[[noreturn]] void refuse_vertex(const TriangleMesh& mesh, const std::string& name) {
  std::size_t i = 0;
  while (is_usable(mesh.positions[i])) ++i;
  fail(name + ", vertex " + std::to_string(i) + " is " + show(mesh.positions[i]) +
       ", expected finite coordinates of at most 2^126");
}

[[noreturn]] void refuse_index(const TriangleMesh& mesh, const std::string& name) {
  const std::size_t vertices = mesh.positions.size();
  for (std::size_t i = 0;; ++i)
    for (const std::uint32_t index : mesh.indices[i])
      if (index >= vertices)
        fail(name + ", triangle " + std::to_string(i) + " has index " + std::to_string(index) +
             ", but there are " + std::to_string(vertices) + " vertices");
}

void check_mesh(const TriangleMesh& mesh, const std::string& name, Executor& executor) {
  // Look at all without a branch, which the compiler turns into vectors; only a failure is looked for.
  constexpr std::size_t kGrain = 1 << 16;
  std::atomic<bool> is_bad = false;
  executor.for_range(0, mesh.positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    unsigned found = 0;
    for (const Vec3& p : std::span(mesh.positions).subspan(begin, end - begin))
      found |= unsigned(!(std::abs(p.x) <= kMaxCoordinate)) | unsigned(!(std::abs(p.y) <= kMaxCoordinate)) |
               unsigned(!(std::abs(p.z) <= kMaxCoordinate));
    if (found) is_bad = true;
  });
  if (is_bad) refuse_vertex(mesh, name);
  const std::size_t vertices = mesh.positions.size();
  executor.for_range(0, mesh.indices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint32_t largest = 0;
    for (const auto& [i, j, k] : std::span(mesh.indices).subspan(begin, end - begin))
      largest = std::max(std::max(largest, i), std::max(j, k));
    if (largest >= vertices) is_bad = true;
  });
  if (is_bad) refuse_index(mesh, name);
  const auto check_length = [&](std::size_t length, const char* what) {
    if (length != 0 && length != vertices)
      fail(name + " has " + std::to_string(length) + " " + what + ", expected none or one for each of the " +
           std::to_string(vertices) + " vertices");
  };
  check_length(mesh.normals.size(), "normals");
  check_length(mesh.uvs.size(), "texture coordinates");
  check_length(mesh.second_uvs.size(), "second texture coordinates");
  check_length(mesh.colors.size(), "colors");
}

void check_shape_boxes(const auto& shapes, const std::string& name) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Box3 box = shapes[i].box();
    if (!box.is_empty() && !(is_usable(box.lower) && is_usable(box.upper)))
      fail(name + ", shape " + std::to_string(i) + " reaches from " + show(box.lower) + " to " +
           show(box.upper) + ", expected finite coordinates of at most 2^126");
  }
}

void check_textures(const SceneDesc& desc) {
  for (std::size_t i = 0; i < desc.textures.size(); ++i) {
    const Texture& texture = desc.textures[i];
    const std::string name = "texture " + std::to_string(i) + " '" + texture.name + "'";
    if (texture.kind == Texture::Kind::picture) {
      if (!texture.source && texture.texels.size() != std::size_t(texture.width) * texture.height)
        fail(name + " has " + std::to_string(texture.texels.size()) + " texels, expected " +
             std::to_string(texture.width) + " times " + std::to_string(texture.height));
      continue;
    }
    // Each stands on earlier ones, so none stands on itself.
    for (const Texture::Operand* operand : {&texture.first, &texture.second, &texture.amount})
      if (operand->texture.is_valid() && operand->texture.value >= i)
        fail(name + " is made of texture " + std::to_string(operand->texture.value) +
             ", expected one that stands before it");
  }
}

void check_materials(const SceneDesc& desc) {
  for (std::size_t i = 0; i < desc.materials.size(); ++i) {
    const Material& m = desc.materials[i];
    const std::string name = "material '" + m.name + "'";
    for_each_texture(m, [&](TextureId id) {
      if (id.is_valid() && id.value >= desc.textures.size())
        fail(name + " has texture " + std::to_string(id.value) + ", but there are " +
             std::to_string(desc.textures.size()));
    });
    if (m.kind != Material::Kind::mix) continue;
    for (const MaterialId id : {m.first, m.second})
      if (id.is_valid() && id.value >= i)
        fail(name + " is a mix of material " + std::to_string(id.value) +
             ", expected one that stands before it");
  }
}

}  // namespace

GeometryId SceneDesc::add(Geometry geometry) {
  geometries.push_back(std::move(geometry));
  return GeometryId(geometries.size() - 1);
}
GeometryId SceneDesc::add(TriangleMesh mesh, MaterialId material) {
  return add(Geometry{std::move(mesh), material, {}, {}});
}
InstanceId SceneDesc::add(const Instance& instance) {
  instances.push_back(instance);
  return InstanceId(instances.size() - 1);
}
MaterialId SceneDesc::add(Material material) {
  materials.push_back(std::move(material));
  return MaterialId(materials.size() - 1);
}
TextureId SceneDesc::add(Texture texture) {
  textures.push_back(std::move(texture));
  return TextureId(textures.size() - 1);
}

std::size_t primitive_count(const Geometry& geometry) {
  return std::visit(
      [](const auto& shapes) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>)
          return shapes.indices.size();
        else
          return shapes.size();
      },
      geometry.shapes);
}

std::size_t defined_primitive_count(const SceneDesc& desc) {
  std::size_t count = 0;
  for (const Geometry& geometry : desc.geometries) count += primitive_count(geometry);
  return count;
}

std::size_t shown_primitive_count(const SceneDesc& desc) {
  if (desc.instances.empty()) return defined_primitive_count(desc);
  std::size_t count = 0;
  for (const Instance& instance : desc.instances)
    count += primitive_count(desc.geometries[instance.geometry.value]);
  return count;
}

std::vector<Instance> placed_instances(const SceneDesc& desc) {
  if (!desc.instances.empty()) return desc.instances;
  std::vector<Instance> placed(desc.geometries.size());
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i].geometry = GeometryId(i);
  return placed;
}

void check(const SceneDesc& desc, Executor& executor) {
  const auto check_material = [&](MaterialId id, const std::string& name) {
    if (id.is_valid() && id.value >= desc.materials.size())
      fail(name + " has material " + std::to_string(id.value) + ", but there are " +
           std::to_string(desc.materials.size()));
  };

  for (std::size_t g = 0; g < desc.geometries.size(); ++g) {
    const Geometry& geometry = desc.geometries[g];
    std::string name = "geometry " + std::to_string(g);
    if (!geometry.name.empty()) name += " '" + geometry.name + "'";

    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
      check_mesh(*mesh, name, executor);
    } else {
      std::visit(
          [&](const auto& shapes) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>)
              check_shape_boxes(shapes, name);
          },
          geometry.shapes);
    }
    check_material(geometry.material, name);
    if (!geometry.materials.empty() && geometry.materials.size() != primitive_count(geometry))
      fail(name + " has " + std::to_string(geometry.materials.size()) +
           " materials, expected none or one for each of the " + std::to_string(primitive_count(geometry)) +
           " primitives");
    for (const MaterialId id : geometry.materials) check_material(id, name);
  }

  for (std::size_t i = 0; i < desc.instances.size(); ++i) {
    const Instance& instance = desc.instances[i];
    const std::string name = "instance " + std::to_string(i);
    if (instance.geometry.value >= desc.geometries.size())
      fail(name + " places geometry " + std::to_string(instance.geometry.value) + ", but there are " +
           std::to_string(desc.geometries.size()));
    check_material(instance.material, name);
    try {
      (void)inverse(instance.world_from_object);
    } catch (const std::invalid_argument& error) {
      fail(name + ": " + error.what());
    }
  }

  check_textures(desc);
  check_materials(desc);
  for (std::size_t i = 0; i < desc.environments.size(); ++i) {
    const Environment& environment = desc.environments[i];
    const Image& image = environment.radiance;
    const std::string name = "environment " + std::to_string(i);
    if (image.channels != 3 || image.width < 1 || image.height < 1 ||
        image.pixels.size() != std::size_t(image.width) * image.height * 3)
      fail(name + " has no picture of three channels");
    try {
      (void)inverse(environment.world_from_environment);
    } catch (const std::invalid_argument& error) {
      fail(name + ": " + error.what());
    }
  }
}

}  // namespace boxwood
