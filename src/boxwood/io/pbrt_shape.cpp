#include "boxwood/io/pbrt_shape.h"

#include <algorithm>
#include <cmath>

#include "boxwood/io/loop_subdivision.h"
#include "boxwood/io/revolution.h"

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

constexpr float kDegree = 3.14159265358979f / 180;
constexpr int kProfileSteps = 48;  // of a quarter or a half circle

/// "phimax" in radians.
float turn_of(const Directive& directive) {
  const float phi = directive.parameters.number("phimax", 360);
  if (!(phi > 0 && phi <= 360))
    fail(directive.place, "\"phimax\" is " + std::to_string(phi) + ", expected more than 0 and at most 360");
  return phi * kDegree;
}

float radius_of(const Directive& directive, const char* what) {
  const float radius = directive.parameters.number("radius", 1);
  if (!(radius > 0))
    fail(directive.place,
         std::string(what) + "'s radius is " + std::to_string(radius) + ", expected more than 0");
  return radius;
}

std::optional<ShapeValue> sphere(const Directive& directive, const ShapeFrame& frame, TriangleMesh& part) {
  const ParameterList& parameters = directive.parameters;
  const float radius = radius_of(directive, "the sphere"), turn = turn_of(directive);
  const float low = std::clamp(parameters.number("zmin", -radius), -radius, radius),
              high = std::clamp(parameters.number("zmax", radius), -radius, radius);
  const bool is_whole = low <= -radius * 0.9999f && high >= radius * 0.9999f && turn > 359.96f * kDegree;
  // A sphere of ours shines outwards and knows no other way round.
  if (is_whole && !frame.is_reversed && !frame.has_relief) {
    const Affine3& m = frame.world_from_object;
    return round_shape(Sphere{{0, 0, 0}, radius}, m, [&](float scale) {
      return Sphere{m.origin, radius * scale};
    });
  }
  if (!(low < high)) fail(directive.place, "the sphere has no part between \"zmin\" and \"zmax\"");
  const float first = std::asin(low / radius), last = std::asin(high / radius);
  part = revolve(
      [&](float v) {
        const float angle = first + (last - first) * v, c = std::cos(angle), s = std::sin(angle);
        return ProfilePoint{radius * c, radius * s, c, s};
      },
      turn, kProfileSteps);
  return std::nullopt;
}

std::optional<ShapeValue> disk(const Directive& directive, const ShapeFrame& frame, TriangleMesh& part) {
  const ParameterList& parameters = directive.parameters;
  const float radius = radius_of(directive, "the disk"), turn = turn_of(directive);
  const float height = parameters.number("height", 0), inner = parameters.number("innerradius", 0);
  if (!(inner >= 0 && inner < radius))
    fail(directive.place, "the disk's inner radius is " + std::to_string(inner) +
                              ", expected at least 0 and less than the radius");
  if (inner == 0 && turn > 359.96f * kDegree && !frame.has_relief) {
    const Disk plain{{0, 0, height}, {0, 0, frame.is_reversed ? -1.0f : 1.0f}, radius};
    const Affine3& m = frame.world_from_object;
    return round_shape(plain, m, [&](float scale) {
      return Disk{m.point(plain.center), m.vector(plain.facing), radius * scale};
    });
  }
  part = revolve([&](float v) { return ProfilePoint{radius + (inner - radius) * v, height, 0, 1}; }, turn, 1);
  return std::nullopt;
}

/// Cylinders, cones and paraboloids along z.
TriangleMesh quadric(const std::string& kind, const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  const float radius = radius_of(directive, "the shape"), turn = turn_of(directive);
  if (kind == "cone") {
    const float height = parameters.number("height", 1);
    return revolve(
        [&](float v) {
          return ProfilePoint{radius * (1 - v), height * v, height, radius};
        },
        turn, 1);
  }
  const float low = parameters.number("zmin", kind == "cylinder" ? -1.0f : 0.0f),
              high = parameters.number("zmax", 1);
  if (kind == "cylinder")
    return revolve([&](float v) { return ProfilePoint{radius, low + (high - low) * v, 1, 0}; }, turn, 1);
  if (!(low >= 0 && low < high))
    fail(directive.place, "the paraboloid reaches from \"zmin\" " + std::to_string(low) + " to \"zmax\" " +
                              std::to_string(high) + ", expected 0 <= zmin < zmax");
  return revolve(
      [&](float v) {
        const float z = low + (high - low) * v, r = radius * std::sqrt(z / high);
        return ProfilePoint{r, z, 2 * high * r / (radius * radius), -1};
      },
      turn, kProfileSteps);
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

  // Exporters write objects that have no faces.
  const bool is_mesh = kind == "trianglemesh" || kind == "bilinearmesh" || kind == "loopsubdiv";
  if (const Parameter* positions = parameters.find("P");
      is_mesh && positions != nullptr && positions->numbers.empty()) {
    warnings.once(directive.place, "a mesh without vertices (\"point3 P\") is left out");
    return std::nullopt;
  }

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
    parameters.ignore({"scheme"});
    const int levels = std::clamp(parameters.integer("levels", parameters.integer("nlevels", 3)), 0, 10);
    take_mesh(subdivide(triangle_mesh(directive), levels));
  } else if (kind == "sphere" || kind == "disk") {
    TriangleMesh part;
    std::optional<ShapeValue> whole =
        kind == "sphere" ? sphere(directive, frame, part) : disk(directive, frame, part);
    if (whole)
      value = std::move(*whole);
    else
      take_mesh(std::move(part));
  } else if (kind == "cylinder" || kind == "cone" || kind == "paraboloid") {
    take_mesh(quadric(kind, directive));
  } else {
    warnings.once(directive.place,
                  "shapes of the kind " + in_quotes(kind) + " are not supported and left out");
    return std::nullopt;
  }
  if (value.geometry.name.empty())
    value.geometry.name = kind + " of line " + std::to_string(directive.place.line);
  return value;
}

}  // namespace boxwood::io::pbrt
