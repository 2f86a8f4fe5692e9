#include "boxwood/io/pbrt_shape.h"

#include <cmath>

namespace boxwood::io::pbrt {
namespace {

void turn_over(std::array<std::uint32_t, 3>& triangle) {
  std::swap(triangle[1], triangle[2]);
}

/// How much a similarity enlarges; 0 for a transform that bends angles.
float scale_of_similarity(const Affine3& m) {
  const double xx = length_squared(m.x), yy = length_squared(m.y), zz = length_squared(m.z);
  const double skew = std::fabs(dot(m.x, m.y)) + std::fabs(dot(m.y, m.z)) + std::fabs(dot(m.z, m.x));
  const bool is_similarity = std::fabs(xx - yy) + std::fabs(yy - zz) + skew <= 1e-5 * xx;
  return is_similarity ? static_cast<float>(std::sqrt((xx + yy + zz) / 3)) : 0.0f;
}

/// The arrays that meshes of all kinds share; `corners` to a face.
struct MeshArrays {
  TriangleMesh mesh;
  std::vector<std::uint32_t> indices;
};

MeshArrays read_arrays(const Directive& directive, std::size_t corners) {
  const ParameterList& parameters = directive.parameters;
  MeshArrays out;
  out.mesh.positions = parameters.vectors3("P");
  out.mesh.normals = parameters.vectors3("N");
  out.mesh.uvs = parameters.vectors2(parameters.find("uv") != nullptr ? "uv" : "st");
  const std::size_t vertices = out.mesh.positions.size();
  if (vertices == 0) fail(directive.place, directive.subject() + " has no vertices (\"point3 P\")");
  out.indices = parameters.indices("indices", vertices);

  // The indices of a single face need not be written.
  if (parameters.find("indices") == nullptr) {
    if (vertices != corners)
      fail(directive.place,
           directive.subject() + " has " + std::to_string(vertices) + " vertices and no \"integer indices\"");
    for (std::size_t i = 0; i < corners; ++i) out.indices.push_back(static_cast<std::uint32_t>(i));
  }
  if (out.indices.size() % corners != 0)
    fail(directive.place, directive.subject() + " has " + std::to_string(out.indices.size()) +
                              " indices, expected a multiple of " + std::to_string(corners));
  const auto check_length = [&](std::size_t length, const char* name) {
    if (length != 0 && length != vertices)
      fail(directive.place, directive.subject() + " has " + std::to_string(length) + " " + name +
                                ", expected one for each of the " + std::to_string(vertices) + " vertices");
  };
  check_length(out.mesh.normals.size(), "normals");
  check_length(out.mesh.uvs.size(), "texture coordinates");
  return out;
}

TriangleMesh triangle_mesh(const Directive& directive) {
  MeshArrays arrays = read_arrays(directive, 3);
  arrays.mesh.indices.resize(arrays.indices.size() / 3);
  for (std::size_t i = 0; i < arrays.mesh.indices.size(); ++i)
    arrays.mesh.indices[i] = {arrays.indices[3 * i], arrays.indices[3 * i + 1], arrays.indices[3 * i + 2]};
  return std::move(arrays.mesh);
}

/// Each patch, whose corners are listed row by row, as two triangles.
TriangleMesh bilinear_mesh(const Directive& directive) {
  MeshArrays arrays = read_arrays(directive, 4);
  for (std::size_t i = 0; i < arrays.indices.size(); i += 4) {
    const std::uint32_t* corner = &arrays.indices[i];
    arrays.mesh.indices.push_back({corner[0], corner[1], corner[3]});
    arrays.mesh.indices.push_back({corner[0], corner[3], corner[2]});
  }
  return std::move(arrays.mesh);
}

bool differs(float a, float b) {
  return std::fabs(a - b) > 1e-4f * std::fabs(b);
}

/// A sphere or a disk: baked by `baked(m, scale)` where m keeps it round, else `plain` placed by an instance.
template <class Round, class Bake>
ShapeValue round_shape(const Round& plain, const Affine3& m, const Bake& baked) {
  ShapeValue value;
  if (const float scale = scale_of_similarity(m); scale > 0) {
    value.geometry.shapes = std::vector<Round>{baked(scale)};
  } else {
    value.geometry.shapes = std::vector<Round>{plain};
    value.placement = m;
  }
  return value;
}

ShapeValue sphere(const Directive& directive, const ShapeFrame& frame, Warnings& warnings) {
  const ParameterList& parameters = directive.parameters;
  const float radius = parameters.number("radius", 1);
  if (!(radius > 0))
    fail(directive.place, "the sphere's radius is " + std::to_string(radius) + ", expected more than 0");
  if (differs(parameters.number("phimax", 360), 360) ||
      parameters.number("zmin", -radius) > -radius * 0.9999f ||
      parameters.number("zmax", radius) < radius * 0.9999f)
    warnings.once(directive.place,
                  "parts of spheres (\"zmin\", \"zmax\", \"phimax\") are not supported; they are whole");
  if (frame.is_reversed)
    warnings.once(directive.place, "ReverseOrientation of spheres is not supported; their front is outside");
  const Affine3& m = frame.world_from_object;
  return round_shape(Sphere{{0, 0, 0}, radius}, m, [&](float scale) {
    return Sphere{m.origin, radius * scale};
  });
}

ShapeValue disk(const Directive& directive, const ShapeFrame& frame, Warnings& warnings) {
  const ParameterList& parameters = directive.parameters;
  const float radius = parameters.number("radius", 1), height = parameters.number("height", 0);
  if (!(radius > 0))
    fail(directive.place, "the disk's radius is " + std::to_string(radius) + ", expected more than 0");
  if (differs(parameters.number("phimax", 360), 360) || parameters.number("innerradius", 0) > 0)
    warnings.once(directive.place,
                  "parts of disks (\"innerradius\", \"phimax\") are not supported; they are whole");
  const Disk plain{{0, 0, height}, {0, 0, frame.is_reversed ? -1.0f : 1.0f}, radius};
  const Affine3& m = frame.world_from_object;
  return round_shape(plain, m, [&](float scale) {
    return Disk{m.point(plain.center), m.vector(plain.facing), radius * scale};
  });
}

}  // namespace

void bake(TriangleMesh& mesh, const ShapeFrame& frame) {
  const Affine3& m = frame.world_from_object;
  if (!(m == Affine3::identity())) {
    for (Vec3& p : mesh.positions) p = m.point(p);
    if (!mesh.normals.empty()) {
      const Affine3 object_from_world = inverse(m);
      for (Vec3& n : mesh.normals) {
        n = transform_normal(object_from_world, n);
        const float size = length(n);
        if (size > 0) n = n / size;
      }
    }
  }
  if (frame.is_reversed)
    for (Vec3& n : mesh.normals) n = -n;

  // Turn triangles so that their front is where pbrt sees it.
  if (mesh.normals.empty()) {
    if ((determinant(m) < 0) != frame.is_reversed)
      for (auto& triangle : mesh.indices) turn_over(triangle);
    return;
  }
  for (auto& triangle : mesh.indices) {
    const auto [a, b, c] = triangle;
    const Vec3 facing = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    if (dot(facing, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) < 0) turn_over(triangle);
  }
}

std::optional<ShapeValue> make_shape(const Directive& directive, const ShapeFrame& frame,
                                     const Parser& parser, Warnings& warnings) {
  const std::string& kind = directive.strings[0];
  const ParameterList& parameters = directive.parameters;
  const double size = determinant(frame.world_from_object);
  if (!(std::fabs(size) > 0) || !std::isfinite(size))
    fail(directive.place,
         directive.subject() + " stands under a transform that flattens space or is not finite");

  ShapeValue value;
  const auto take_mesh = [&](TriangleMesh mesh) {
    parameters.ignore({"faceIndices"});  // ids for other programs
    bake(mesh, frame);
    value.geometry.shapes = std::move(mesh);
  };
  if (kind == "trianglemesh") {
    take_mesh(triangle_mesh(directive));
  } else if (kind == "plymesh") {
    const std::string file = parameters.string("filename", "");
    if (file.empty()) fail(directive.place, "Shape \"plymesh\" has no \"filename\"");
    value.ply = parser.resolve(file);
    value.geometry.name = value.ply.stem().string();
  } else if (kind == "bilinearmesh") {
    take_mesh(bilinear_mesh(directive));
  } else if (kind == "loopsubdiv") {
    parameters.ignore({"levels", "nlevels", "scheme"});
    take_mesh(triangle_mesh(directive));
    warnings.once(directive.place, "subdivision surfaces are not supported; their control meshes stand in");
  } else if (kind == "sphere") {
    value = sphere(directive, frame, warnings);
  } else if (kind == "disk") {
    value = disk(directive, frame, warnings);
  } else {
    warnings.once(directive.place,
                  "shapes of the kind " + in_quotes(kind) + " are not supported and left out");
    return std::nullopt;
  }
  parameters.warn_unused(directive.subject(), warnings);
  if (value.geometry.name.empty())
    value.geometry.name = kind + " of line " + std::to_string(directive.place.line);
  return value;
}

}  // namespace boxwood::io::pbrt
