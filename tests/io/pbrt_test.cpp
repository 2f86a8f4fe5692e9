// What a pbrt scene becomes, in both versions of the format, and what a broken one says.
#include <cmath>

#include "boxwood/core/random.h"
#include "boxwood/io/image.h"
#include "boxwood/io/load.h"
#include "boxwood/scene/scene.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

class Pbrt : public Files {
 protected:
  SceneDesc scene(const std::string& text) { return load(write("scene.pbrt", text)); }
  std::string error(const std::string& text) {
    return message_of<FileError>([&] { (void)scene(text); });
  }
  /// Expects an error that names the scene's file and line, and what is wrong.
  void expect_error(const std::string& text, int line, const std::string& part) {
    const std::string message = error(text);
    EXPECT_CONTAINS(message, path("scene.pbrt").string() + ":" + std::to_string(line) + ": ");
    EXPECT_CONTAINS(message, part);
  }
  static const TriangleMesh& mesh(const SceneDesc& desc, std::size_t i = 0) {
    return std::get<TriangleMesh>(desc.geometries.at(i).shapes);
  }
  static const Material& material(const SceneDesc& desc, std::size_t geometry = 0) {
    return desc.materials.at(desc.geometries.at(geometry).material.value);
  }
};

const std::string kTriangle =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  1 0 0  0 1 0]\n";

void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
  EXPECT_LE(length(a - b), tolerance)
      << "(" << a.x << " " << a.y << " " << a.z << ") instead of (" << b.x << " " << b.y << " " << b.z << ")";
}

Vec3 facing(const TriangleMesh& mesh, std::size_t triangle = 0) {
  const auto [a, b, c] = mesh.indices.at(triangle);
  return normalize(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

TEST_F(Pbrt, ReadsWordsStringsBracketsAndCommentsInAnyLayout) {
  const SceneDesc desc = scene(
      "# a comment with \"quotes\" and [brackets\n"
      "WorldBegin\nShape\"trianglemesh\"# no blanks\n\"integer indices\"[0 1\n2]\"point3 P\"[0 0 0 1 0 0 0 "
      "+1e0 0]"
      "\"point2 uv\" [0 0 1 0 0 1]\r\n\tWorldEnd");
  ASSERT_EQ(defined_primitive_count(desc), 1u);
  EXPECT_EQ(mesh(desc).positions[2], (Vec3{0, 1, 0}));
  EXPECT_EQ(mesh(desc).uvs[1], (Vec2{1, 0}));
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, TransformsComposeAsWritten) {
  const SceneDesc desc = scene("WorldBegin Translate 1 2 3 Rotate 90 0 0 1 Scale 2 2 2\n" + kTriangle +
                               "Identity ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1] " + kTriangle +
                               "CoordinateSystem \"here\" Transform [0 1 0 0  1 0 0 0  0 0 1 0  0 0 0 1] " +
                               kTriangle + "CoordSysTransform \"here\" " + kTriangle);
  expect_near(mesh(desc, 0).positions[1], {1, 4, 3});
  expect_near(mesh(desc, 0).positions[2], {-1, 2, 3});
  expect_near(mesh(desc, 1).positions[1], {6, 6, 7});
  expect_near(mesh(desc, 2).positions[1], {0, 1, 0});
  expect_near(mesh(desc, 3).positions[1], {6, 6, 7});
}

TEST_F(Pbrt, AttributesEndWithTheirBlock) {
  const SceneDesc desc = scene(
      "WorldBegin Material \"matte\" \"rgb Kd\" [.1 .2 .3]\n"
      "AttributeBegin Translate 1 0 0 Material \"mirror\" TransformBegin Translate 1 0 0 Material \"glass\" "
      "TransformEnd\n" +
      kTriangle + "AttributeEnd\n" + kTriangle);
  EXPECT_EQ(mesh(desc, 0).positions[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(material(desc, 0).kind, Material::Kind::glass);  // TransformEnd gives back the transform only
  EXPECT_EQ(mesh(desc, 1).positions[0], (Vec3{0, 0, 0}));
  EXPECT_EQ(material(desc, 1).color, (Vec3{.1f, .2f, .3f}));
}

TEST_F(Pbrt, FrontSidesFollowTransformsOrientationAndNormals) {
  const SceneDesc desc =
      scene("WorldBegin\n" + kTriangle + "AttributeBegin Scale -1 1 1\n" + kTriangle +
            "ReverseOrientation\n" + kTriangle + "AttributeEnd ReverseOrientation\n" + kTriangle +
            "ReverseOrientation Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] "
            "\"normal N\" [0 0 -1 0 0 -1 0 0 -1]\n");
  expect_near(facing(mesh(desc, 0)), {0, 0, 1});
  expect_near(facing(mesh(desc, 1)), {0, 0, 1});
  expect_near(facing(mesh(desc, 2)), {0, 0, -1});
  expect_near(facing(mesh(desc, 3)), {0, 0, -1});
  expect_near(facing(mesh(desc, 4)), {0, 0, -1});
}

/// Where a world point falls on the picture: right, up and forward of the camera.
Vec3 seen(const Camera& camera, Vec3 p) {
  const Vec3 q = inverse(camera.world_from_camera).point(p);
  return {q.x, q.y, -q.z};
}

TEST_F(Pbrt, CameraLooksForwardAndKeepsOrMirrorsTheWorldAsPbrtDoes) {
  // pbrt's own frame: at the origin, along +z, +x to the right.
  SceneDesc desc = scene(
      "Film \"image\" \"integer xresolution\" 320 \"integer yresolution\" [200]\n"
      "Camera \"perspective\" \"float fov\" 35 WorldBegin " +
      kTriangle);
  ASSERT_TRUE(desc.camera);
  EXPECT_EQ(desc.camera->fov_deg, 35);
  EXPECT_EQ(desc.camera->width, 320);
  EXPECT_EQ(desc.camera->height, 200);
  expect_near(seen(*desc.camera, {1, 2, 3}), {1, 2, 3});

  // LookAt keeps right on the right: from (0, 0, -5) towards the origin, +x is on the right.
  desc = scene("LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin " + kTriangle);
  expect_near(seen(*desc.camera, {1, 2, 0}), {1, 2, 5});
  EXPECT_EQ(desc.camera->fov_deg, 90);

  // From the other side, right is -x; a Scale -1 before it turns the picture over.
  desc = scene("LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin " + kTriangle);
  expect_near(seen(*desc.camera, {1, 2, 0}), {-1, 2, 5});
  desc = scene("Scale -1 1 1 LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin " + kTriangle);
  expect_near(seen(*desc.camera, {1, 2, 0}), {1, 2, 5});

  // Lengths of the lens are the camera's: a scale makes them larger in the world.
  desc = scene(
      "Scale .5 .5 .5 Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 4 WorldBegin " +
      kTriangle);
  EXPECT_FLOAT_EQ(desc.camera->lens_radius, .2f);
  EXPECT_FLOAT_EQ(desc.camera->focus_distance, 8);
  EXPECT_FLOAT_EQ(length(desc.camera->world_from_camera.z), 1);
}

TEST_F(Pbrt, CameraCoordinateSystemPlacesThingsBeforeTheCamera) {
  const SceneDesc desc = scene(
      "LookAt 3 4 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin\n"
      "CoordSysTransform \"camera\" Shape \"sphere\" \"float radius\" 2\n");
  expect_near(std::get<std::vector<Sphere>>(desc.geometries[0].shapes)[0].center, {3, 4, 5});
}

TEST_F(Pbrt, ObjectsAreReadOnceAndPlacedOftenUnderTheTransformOfTheInstance) {
  const SceneDesc desc =
      scene("WorldBegin " + kTriangle + "ObjectBegin \"tree\" Translate 0 0 1 " + kTriangle +
            "Shape \"sphere\" ObjectEnd\nObjectBegin \"unused\" " + kTriangle + "ObjectEnd\n" +
            "AttributeBegin Translate 10 0 0 ObjectInstance \"tree\" AttributeEnd\n"
            "Scale 2 2 2 ObjectInstance \"tree\"\n");
  ASSERT_EQ(desc.geometries.size(), 3u);
  ASSERT_EQ(desc.instances.size(), 5u);
  EXPECT_EQ(shown_primitive_count(desc), 5u);
  EXPECT_EQ(desc.instances[0].world_from_object, Affine3::identity());
  EXPECT_EQ(desc.instances[1].geometry, desc.instances[3].geometry);
  EXPECT_EQ(mesh(desc, 1).positions[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(desc.instances[1].world_from_object, Affine3::translation({10, 0, 0}));
  EXPECT_EQ(desc.instances[3].world_from_object, Affine3::scale(2));
}

TEST_F(Pbrt, SpheresAndDisksStayRoundOrAreInstances) {
  const SceneDesc desc = scene(
      "WorldBegin Translate 1 2 3 AttributeBegin Rotate 30 1 1 0 Scale 2 2 -2\n"
      "Shape \"sphere\" \"float radius\" 3 AttributeEnd\n"
      "AttributeBegin Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 2 \"float height\" 1 AttributeEnd\n"
      "Scale 1 2 1 Shape \"sphere\" \"float radius\" 3 Shape \"disk\"\n");
  const Sphere sphere = std::get<std::vector<Sphere>>(desc.geometries[0].shapes)[0];
  expect_near(sphere.center, {1, 2, 3});
  EXPECT_NEAR(sphere.radius, 6, 1e-5);
  const Disk disk = std::get<std::vector<Disk>>(desc.geometries[1].shapes)[0];
  expect_near(disk.center, {1, 1, 3});
  expect_near(normalize(disk.facing), {0, -1, 0});
  EXPECT_NEAR(disk.radius, 2, 1e-5);
  EXPECT_EQ(std::get<std::vector<Sphere>>(desc.geometries[2].shapes)[0].radius, 3);
  EXPECT_EQ(desc.instances[2].world_from_object.y, (Vec3{0, 2, 0}));

  // A ray finds the stretched sphere where it should be.
  Ray ray;
  ray.origin = {1, 20, 3};
  ray.direction = {0, -1, 0};
  const Hit hit = Scene(desc).closest_hit(ray);
  ASSERT_TRUE(hit.is_hit());
  EXPECT_NEAR(hit.t, 20 - (2 + 6), 1e-4);
}

TEST_F(Pbrt, BilinearMeshesAndSubdivisionCagesBecomeTriangles) {
  const SceneDesc desc = scene(
      "WorldBegin Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
      "Shape \"loopsubdiv\" \"integer levels\" 3 \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 "
      "0]\n");
  ASSERT_EQ(mesh(desc, 0).indices.size(), 2u);
  expect_near(facing(mesh(desc, 0), 0), {0, 0, 1});
  expect_near(facing(mesh(desc, 0), 1), {0, 0, 1});
  const Scene built(desc);
  for (const Vec3 p : {Vec3{.9f, .1f, 5}, Vec3{.1f, .9f, 5}}) {
    Ray ray;
    ray.origin = p;
    ray.direction = {0, 0, -1};
    EXPECT_TRUE(built.any_hit(ray));
  }
  EXPECT_EQ(mesh(desc, 1).indices.size(), 64u);  // four times as many at each of three levels
  EXPECT_EQ(mesh(desc, 1).normals.size(), mesh(desc, 1).positions.size());
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, SubdivisionOfAnOctahedronIsRoundAndPlanesStayPlane) {
  const SceneDesc desc = scene(
      "WorldBegin Shape \"loopsubdiv\" \"integer levels\" 4 \"integer indices\" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 "
      "5 "
      "1 2 5 3 1 5 0 3 5] \"point P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1]\n"
      "Shape \"loopsubdiv\" \"integer levels\" 2 \"integer indices\" [0 1 2 0 2 3] \"point P\" [0 0 0 1 0 0 "
      "1 1 "
      "0 0 1 0]\n");
  float least = 9, most = 0;
  const TriangleMesh& ball = mesh(desc, 0);
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    least = std::min(least, length(ball.positions[i]));
    most = std::max(most, length(ball.positions[i]));
    EXPECT_GT(dot(ball.normals[i], normalize(ball.positions[i])), .9f);
  }
  // The corners' limit by Loop's mask for four neighbours: 1 - 4 w with w = 1 / (4 + 4). Between the corners
  // the limit surface comes as near as 0.4157, by subdividing six times elsewhere.
  EXPECT_NEAR(most, .5f, 1e-5f);
  EXPECT_NEAR(least, .4157f, 1e-3f);
  for (const Vec3 n : mesh(desc, 1).normals) expect_near(n, {0, 0, 1});
  for (const Vec3 p : mesh(desc, 1).positions) EXPECT_EQ(p.z, 0);
}

TEST_F(Pbrt, PartsOfQuadricsAreMeshesOnTheSurfaceFacingOutwards) {
  const SceneDesc desc = scene(
      "WorldBegin Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float phimax\" 180\n"
      "Shape \"disk\" \"float innerradius\" .5\nShape \"cylinder\" \"float radius\" 3 \"float zmax\" 4\n"
      "Shape \"cone\" \"float height\" 2\nShape \"paraboloid\" \"float zmax\" 2\n"
      "ReverseOrientation Shape \"sphere\"\n");
  const auto check = [&](std::size_t geometry, auto distance) {
    const TriangleMesh& m = mesh(desc, geometry);
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
      EXPECT_NEAR(distance(m.positions[i]), 0, 1e-4f) << geometry;
      // The gradient of the distance is the normal.
      Vec3 gradient;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 step{0, 0, 0};
        step[axis] = 1e-2f;
        gradient[axis] = distance(m.positions[i] + step) - distance(m.positions[i] - step);
      }
      const bool is_tip = geometry == 3 && m.positions[i].z > 1.99f;
      if (!is_tip && length(gradient) > 1e-3f) {
        EXPECT_GT(dot(normalize(gradient), m.normals[i]), .99f) << geometry;
      }
    }
    for (std::size_t t = 0; t < m.indices.size(); ++t)
      if (const Vec3 n = facing(m, t); is_finite(n)) {
        EXPECT_GT(
            dot(n, m.normals[m.indices[t][0]] + m.normals[m.indices[t][1]] + m.normals[m.indices[t][2]]), 0);
      }
  };
  const auto across = [](Vec3 p) { return std::sqrt(p.x * p.x + p.y * p.y); };
  check(0, [](Vec3 p) { return length(p) - 2; });
  check(1, [](Vec3 p) { return p.z; });
  check(2, [&](Vec3 p) { return across(p) - 3; });
  check(3, [&](Vec3 p) { return across(p) - (1 - p.z / 2); });
  check(4, [&](Vec3 p) { return p.x * p.x + p.y * p.y - p.z / 2; });
  for (const Vec3 p : mesh(desc, 0).positions) EXPECT_TRUE(p.z > -1.001f && p.y > -1e-4f);
  // Turned over: the front is inside.
  const TriangleMesh& hollow = mesh(desc, 5);
  EXPECT_LT(dot(hollow.normals[500], hollow.positions[500]), 0);
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, IncludesAndMeshFilesAreFoundBesideTheScene) {
  std::filesystem::create_directories(path("parts"));
  write("parts/mesh.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write("parts/one.pbrt", "Shape \"plymesh\" \"string filename\" \"parts/mesh.ply\" Include \"two.pbrt\"\n");
  write("parts/two.pbrt", "Translate 0 0 1 Shape \"plymesh\" \"string filename\" [\"parts/mesh.ply\"]\n");
  const SceneDesc desc = scene("WorldBegin Include \"parts/one.pbrt\"\n" + kTriangle);
  ASSERT_EQ(desc.geometries.size(), 3u);
  EXPECT_EQ(mesh(desc, 0).positions[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh(desc, 1).positions[1], (Vec3{1, 0, 1}));
  EXPECT_EQ(mesh(desc, 2).positions[0], (Vec3{0, 0, 1}));  // an include leaves its transform behind
}

TEST_F(Pbrt, MaterialsOfBothVersionsBecomeOurs) {
  const SceneDesc desc = scene(
      "WorldBegin\n"
      "Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\n" +
      kTriangle +
      "Material \"substrate\" \"rgb Kd\" [.3 .2 .1] \"float uroughness\" .04 \"float vroughness\" .04 \"bool "
      "remaproughness\" \"false\"\n" +
      kTriangle + "Material \"coateddiffuse\" \"float roughness\" .25\n" + kTriangle +
      "Material \"metal\" \"rgb eta\" [1 2 3] \"rgb k\" [0 0 4] \"float roughness\" [1]\n" + kTriangle +
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"bool "
      "remaproughness\" false \"float roughness\" .3\n" +
      kTriangle + "Material \"glass\" \"float index\" 1.33 \"rgb Kt\" [0 0 0]\n" + kTriangle +
      "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n" + kTriangle +
      "Material \"mirror\" \"rgb Kr\" [.7 .7 .7]\n" + kTriangle +
      "Material \"uber\" \"rgb opacity\" [0 0 0]\n" + kTriangle + "Material \"none\"\n" + kTriangle +
      "Material \"plastic\" \"texture Kd\" \"half\"\n" + kTriangle);
  using Kind = Material::Kind;
  EXPECT_EQ(material(desc, 0).kind, Kind::matte);
  EXPECT_EQ(material(desc, 0).color, (Vec3{.1f, .2f, .3f}));
  EXPECT_EQ(material(desc, 1).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 1).roughness, .04f);
  EXPECT_EQ(material(desc, 2).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 2).roughness, .5f);  // version 4 takes the root
  EXPECT_EQ(material(desc, 3).kind, Kind::metal);
  expect_near(material(desc, 3).metal_eta, {1, 2, 3});
  expect_near(material(desc, 3).metal_k, {.001f, .001f, 4});
  EXPECT_FLOAT_EQ(material(desc, 3).roughness, 1);                            // 1.62142, clamped
  EXPECT_GT(material(desc, 4).metal_k.x, 3 * material(desc, 4).metal_eta.x);  // gold shines in red
  EXPECT_FLOAT_EQ(material(desc, 4).roughness, .3f);
  EXPECT_EQ(material(desc, 5).kind, Kind::glass);
  EXPECT_FLOAT_EQ(material(desc, 5).ior, 1.33f);
  EXPECT_EQ(material(desc, 5).color, (Vec3{0, 0, 0}));
  EXPECT_NEAR(material(desc, 6).ior, 1.517, .001);
  EXPECT_EQ(material(desc, 7).kind, Kind::mirror);
  EXPECT_EQ(material(desc, 7).color, splat(.7f));
  for (const int clear : {8, 9}) {
    EXPECT_EQ(material(desc, clear).kind, Kind::clear);
  }
  EXPECT_EQ(material(desc, 10).kind, Kind::layered);  // a quarter of the gloss, unless given
  ASSERT_EQ(desc.warnings.size(), 1u);                // the texture that nobody defined
  EXPECT_CONTAINS(desc.warnings[0], "no texture of the name \"half\"");
}

TEST_F(Pbrt, RoughnessIsRemappedAsVersion3Does) {
  const auto alpha = [&](const std::string& roughness) {
    return material(scene("WorldBegin Material \"metal\" \"float roughness\" " + roughness + " " + kTriangle))
        .roughness;
  };
  const double x = std::log(0.1);
  EXPECT_NEAR(alpha("0.1"),
              1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x,
              1e-5);
  EXPECT_LT(alpha("0.01"), alpha("0.1"));
  EXPECT_EQ(alpha("0"), 0);
}

TEST_F(Pbrt, NamedMaterialsAndLightsMeetInOneMaterial) {
  const SceneDesc desc = scene(
      "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"matte\" \"color Kd\" [1 0 0]\n"
      "NamedMaterial \"m\"\n" +
      kTriangle +
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" "
      "true\n" +
      kTriangle + "AttributeEnd\n" + kTriangle);
  ASSERT_EQ(desc.materials.size(), 2u);
  EXPECT_EQ(desc.materials[0].name, "m");
  EXPECT_EQ(material(desc, 0).emission, (Vec3{0, 0, 0}));
  EXPECT_EQ(material(desc, 1).emission, (Vec3{2, 4, 6}));
  EXPECT_TRUE(material(desc, 1).emits_from_both_sides);
  EXPECT_EQ(material(desc, 1).color, (Vec3{1, 0, 0}));
  EXPECT_EQ(desc.geometries[0].material, desc.geometries[2].material);
}

TEST_F(Pbrt, LightsWithoutSurfaces) {
  const SceneDesc desc = scene(
      "WorldBegin LightSource \"infinite\" \"rgb L\" [.1 .2 .3] LightSource \"infinite\" \"float scale\" 2\n"
      "Translate 0 0 1 LightSource \"point\" \"rgb I\" [4 5 6] \"point3 from\" [1 0 0]\n"
      "Rotate 90 1 0 0 LightSource \"distant\" \"rgb L\" [1 1 1] \"point from\" [0 0 1] \"point to\" [0 0 "
      "0]\n"
      "LightSource \"distant\" \"blackbody L\" 6500\n" +
      kTriangle);
  ASSERT_TRUE(desc.sky);
  expect_near(desc.sky->zenith, {2.1f, 2.2f, 2.3f});
  EXPECT_EQ(desc.sky->ground, desc.sky->zenith);
  ASSERT_EQ(desc.point_lights.size(), 1u);
  EXPECT_EQ(desc.point_lights[0].position, (Vec3{1, 0, 1}));
  EXPECT_EQ(desc.point_lights[0].intensity, (Vec3{4, 5, 6}));
  ASSERT_EQ(desc.distant_lights.size(), 2u);
  expect_near(desc.distant_lights[0].direction, {0, 1, 0});
  expect_near(desc.distant_lights[1].irradiance, {1, 1, 1}, .1f);  // daylight is nearly white
}

TEST_F(Pbrt, ColorsComeInManyForms) {
  const auto color = [&](const std::string& parameter) {
    return material(scene("WorldBegin Material \"matte\" " + parameter + " " + kTriangle)).color;
  };
  expect_near(color("\"float Kd\" .25"), splat(.25f));
  expect_near(color("\"spectrum Kd\" [400 .5 700 .5]"), splat(.5f));
  expect_near(color("\"xyz Kd\" [.95047 1 1.08883]"), splat(1), 1e-3f);
  const Vec3 red = color("\"spectrum Kd\" [400 0 590 0 610 1 700 1]");
  EXPECT_GT(red.x, 5 * red.y);
  write("grey.spd", "# wavelength value\n400 .3\n700 .3\n");
  expect_near(color("\"spectrum Kd\" \"grey.spd\""), splat(.3f));
  const Vec3 glow = color("\"blackbody Kd\" 2700");
  EXPECT_GT(glow.x, glow.y);
  EXPECT_GT(glow.y, glow.z);
}

TEST_F(Pbrt, TexturesBecomeTexturesAndConstantsAreFolded) {
  // A TGA of two by one pixels, red and blue (rows from the bottom, blue first).
  const char tga[] = {0, 0, 2, 0, 0,  0, 0, 0, 0,         0,         0, 0,
                      2, 0, 1, 0, 24, 0, 0, 0, char(255), char(255), 0, 0};
  write("two.tga", std::string_view(tga, sizeof tga));
  const SceneDesc desc = scene(
      "WorldBegin Texture \"picture\" \"spectrum\" \"imagemap\" \"string filename\" \"two.tga\"\n"
      "Texture \"dark\" \"spectrum\" \"scale\" \"texture tex1\" \"picture\" \"rgb tex2\" [.5 .5 .5]\n"
      "Texture \"gone\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\"\n"
      "Texture \"unused\" \"spectrum\" \"imagemap\" \"string filename\" \"also-gone.png\"\n"
      "Texture \"rough\" \"float\" \"constant\" \"float value\" .3\n"
      "Texture \"board\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 0]\n"
      "Material \"matte\" \"texture Kd\" \"picture\"\n" +
      kTriangle + "Material \"matte\" \"texture Kd\" \"dark\"\n" + kTriangle +
      "Material \"matte\" \"texture Kd\" \"gone\"\n" + kTriangle +
      "Material \"metal\" \"texture roughness\" \"rough\" \"bool remaproughness\" \"false\"\n" + kTriangle +
      "Material \"matte\" \"texture Kd\" \"board\"\n" + kTriangle);
  ASSERT_EQ(desc.textures.size(), 2u);
  EXPECT_EQ(desc.textures[0].width, 2);
  ASSERT_TRUE(desc.textures[0].source);
  EXPECT_EQ(desc.textures[0].source->texel(0, 0, 0), (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(desc.textures[0].source->texel(0, 1, 0), (std::array<float, 4>{0, 0, 1, 1}));
  EXPECT_EQ(desc.textures[0].source->levels(), 2);
  EXPECT_EQ(material(desc, 0).color_texture, TextureId(0));
  EXPECT_EQ(material(desc, 0).color, splat(1));
  EXPECT_EQ(material(desc, 1).color_texture, TextureId(0));
  EXPECT_EQ(material(desc, 1).color, splat(.5f));
  EXPECT_FALSE(material(desc, 2).color_texture.is_valid());
  EXPECT_EQ(material(desc, 2).color, splat(.18f));
  EXPECT_FLOAT_EQ(material(desc, 3).roughness, .3f);
  EXPECT_EQ(material(desc, 4).color_texture, TextureId(1));
  EXPECT_EQ(desc.textures[1].kind, Texture::Kind::checkerboard);
  EXPECT_EQ(desc.textures[1].first.color, (Vec3{1, 0, 0}));
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "gone.png");
}

TEST_F(Pbrt, MaterialsOfManyParts) {
  const SceneDesc desc = scene(
      "WorldBegin MakeNamedMaterial \"red\" \"string type\" \"matte\" \"rgb Kd\" [1 0 0]\n"
      "MakeNamedMaterial \"shiny\" \"string type\" \"mirror\"\n"
      "Material \"mix\" \"string namedmaterial1\" \"red\" \"string namedmaterial2\" \"shiny\" \"float "
      "amount\" .3\n" +
      kTriangle + "Material \"mix\" \"string materials\" [\"red\" \"shiny\"] \"float amount\" .3\n" +
      kTriangle +
      "Material \"translucent\" \"rgb Kd\" [.8 .8 .8] \"rgb transmit\" [.25 .25 .25] \"rgb Ks\" [0 0 0]\n" +
      kTriangle + "Material \"diffusetransmission\" \"rgb reflectance\" [.1 .2 .3] \"float scale\" 2\n" +
      kTriangle + "Material \"thindielectric\" \"float eta\" 1.2\n" + kTriangle +
      "Material \"dielectric\" \"float roughness\" .25\n" + kTriangle +
      "Material \"uber\" \"rgb opacity\" [.25 .25 .25]\n" + kTriangle +
      "Material \"coatedconductor\" \"float interface.roughness\" .0625 \"float conductor.roughness\" .25\n" +
      kTriangle + "Material \"disney\" \"float metallic\" .5 \"float roughness\" .4\n" + kTriangle);
  using Kind = Material::Kind;
  for (const int i : {0, 1}) {
    const Material& mix = material(desc, i);
    EXPECT_EQ(mix.kind, Kind::mix);
    // Version 3 gives the share of the first, version 4 that of the second.
    EXPECT_EQ(desc.materials[mix.first.value].name, i == 0 ? "shiny" : "red");
    EXPECT_EQ(desc.materials[mix.second.value].name, i == 0 ? "red" : "shiny");
    EXPECT_FLOAT_EQ(mix.mix_amount, .3f);
  }
  EXPECT_EQ(material(desc, 2).kind, Kind::translucent);
  expect_near(material(desc, 2).color, splat(.4f));
  expect_near(material(desc, 2).transmission_color, splat(.2f));
  expect_near(material(desc, 3).color, {.2f, .4f, .6f});
  expect_near(material(desc, 3).transmission_color, splat(.5f));
  EXPECT_TRUE(material(desc, 4).is_thin);
  EXPECT_FLOAT_EQ(material(desc, 4).ior, 1.2f);
  EXPECT_FLOAT_EQ(material(desc, 5).roughness, .5f);
  EXPECT_EQ(material(desc, 6).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 6).opacity, .25f);
  EXPECT_EQ(material(desc, 7).kind, Kind::layered);
  EXPECT_EQ(material(desc, 7).coat, 1);
  EXPECT_FLOAT_EQ(material(desc, 7).coat_roughness, .5f);
  EXPECT_FLOAT_EQ(material(desc, 8).metalness, .5f);
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, GlossIsAsStrongAsItsColorSays) {
  const SceneDesc desc = scene("WorldBegin Material \"plastic\" \"rgb Ks\" [1 1 1]\n" + kTriangle +
                               "Material \"plastic\" \"rgb Ks\" [.1 .2 .4]\n" + kTriangle +
                               "Material \"plastic\" \"rgb Ks\" [0 0 0]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [.04 .04 .04]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [0 0 0]\n" + kTriangle +
                               "Material \"uber\" \"rgb Ks\" [.5 .5 .5]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [.02 .04 .06]\n" + kTriangle);
  using Kind = Material::Kind;
  EXPECT_EQ(material(desc, 0).kind, Kind::plastic);
  EXPECT_EQ(material(desc, 1).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 1).specular, .4f);
  expect_near(material(desc, 1).specular_color, {.25f, .5f, 1});
  EXPECT_EQ(material(desc, 2).kind, Kind::matte);
  // Of an index of 1.5 a boundary reflects 4% head-on.
  EXPECT_EQ(material(desc, 3).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 3).ior, 1.5f);
  EXPECT_EQ(material(desc, 4).kind, Kind::matte);
  EXPECT_EQ(material(desc, 5).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 5).specular, .5f);
  EXPECT_FLOAT_EQ(material(desc, 6).ior, 1.5f);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "another color than grey");
}

TEST_F(Pbrt, WhatWouldLookOtherwiseIsNamed) {
  const SceneDesc desc = scene(
      "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb Le\" [1 1 1]\n"
      "WorldBegin Material \"disney\" \"float sheentint\" .5\n" +
      kTriangle + "Material \"coatedconductor\" \"float interface.eta\" 2\n" + kTriangle);
  ASSERT_EQ(desc.warnings.size(), 3u);
  EXPECT_CONTAINS(desc.warnings[0], "media that shine are not supported");
  EXPECT_CONTAINS(desc.warnings[1], "sheentint");
  EXPECT_CONTAINS(desc.warnings[2], "interface.eta");
}

TEST_F(Pbrt, MediaAlphaAndNormalMapsBelongToTheMaterial) {
  const SceneDesc desc = scene(
      "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 "
      "0] "
      "\"float scale\" 2\n"
      "WorldBegin Texture \"holes\" \"float\" \"checkerboard\"\n"
      "AttributeBegin MediumInterface \"ink\" \"\" Material \"glass\"\n" +
      kTriangle + "AttributeEnd\nMaterial \"glass\"\n" + kTriangle +
      "Shape \"sphere\" \"texture alpha\" \"holes\"\nShape \"sphere\" \"float alpha\" .5\n"
      "MediumInterface \"nothing\" \"\"\n");
  EXPECT_EQ(material(desc, 0).absorption, (Vec3{2, 4, 6}));
  EXPECT_EQ(material(desc, 0).outer_absorption, (Vec3{0, 0, 0}));
  EXPECT_EQ(material(desc, 1).absorption, (Vec3{0, 0, 0}));
  EXPECT_TRUE(material(desc, 2).opacity_texture.texture.is_valid());
  EXPECT_FLOAT_EQ(material(desc, 3).opacity, .5f);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], ":10: there is no medium of the name \"nothing\"");
}

TEST_F(Pbrt, SpotLightsAndEnvironmentMaps) {
  Image map(4, 2);
  for (float& value : map.pixels) value = 2;
  map.at(1, 1)[0] = std::nanf("");
  map.at(2, 1)[0] = -1;
  write_image(path("sky.exr"), map);
  Image square(8, 8);
  for (int y = 0; y < 8; ++y)  // the middle of the square is +z, its corners are -z
    for (int x = 0; x < 8; ++x)
      square.at(x, y)[0] = std::abs(2 * x - 7) + std::abs(2 * y - 7) < 8 ? 1.0f : 0.0f;
  write_image(path("square.exr"), square);
  const SceneDesc desc = scene(
      "WorldBegin LightSource \"spot\" \"point from\" [0 0 5] \"point to\" [0 0 0] \"float coneangle\" 60 "
      "\"float conedeltaangle\" 15 \"rgb I\" [2 3 4]\n"
      "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"rgb scale\" [1 2 3]\n"
      "LightSource \"infinite\" \"string filename\" \"square.exr\"\n"
      "LightSource \"infinite\" \"string filename\" \"gone.exr\"\n" +
      kTriangle);
  ASSERT_EQ(desc.spot_lights.size(), 1u);
  expect_near(desc.spot_lights[0].direction, {0, 0, -1});
  EXPECT_NEAR(desc.spot_lights[0].outer_cosine, .5f, 1e-6f);
  EXPECT_NEAR(desc.spot_lights[0].inner_cosine, std::sqrt(.5f), 1e-6f);
  ASSERT_EQ(desc.environments.size(), 2u);
  EXPECT_EQ(desc.environments[0].scale, (Vec3{1, 2, 3}));
  EXPECT_EQ(desc.environments[0].radiance.at(1, 1)[0], 0);
  // The upper half of the sphere is bright, the lower is not.
  const Image& unfolded = desc.environments[1].radiance;
  EXPECT_EQ(unfolded.width, 2 * unfolded.height);
  for (int x = 0; x < unfolded.width; ++x) {
    EXPECT_EQ(unfolded.at(x, 0)[0], 1);
    EXPECT_EQ(unfolded.at(x, unfolded.height - 1)[0], 0);
  }
  ASSERT_TRUE(desc.sky);  // white, for the one that is gone
  ASSERT_EQ(desc.warnings.size(), 2u);
  EXPECT_CONTAINS(desc.warnings[0], ":2: the environment map \"sky.exr\" has 2 pixels");
  EXPECT_CONTAINS(desc.warnings[1], ":4: the environment map cannot be read");
}

TEST_F(Pbrt, WhatIsNotSupportedIsNamedOnceAndTheRestLoads) {
  const SceneDesc desc = scene(
      "Option \"bool disablewavelengthjitter\" true ColorSpace \"srgb\"\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4 Integrator \"path\" PixelFilter \"box\" Accelerator "
      "\"bvh\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\"\n"
      "Camera \"orthographic\" WorldBegin\n"
      "Shape \"curve\" \"float radius\" 1\nShape \"curve\"\n"
      "LightSource \"projection\" LightSource \"projection\"\n"
      "Material \"subsurface\" \"rgb reflectance\" [.4 .4 .4]\nMaterial \"subsurface\"\n"
      "NamedMaterial \"nobody\"\n"
      "Attribute \"shape\" \"float radius\" 5 Shape \"sphere\" \"bool strange\" true\n");
  EXPECT_EQ(std::get<std::vector<Sphere>>(desc.geometries.at(0).shapes)[0].radius, 5);
  const char* expected[] = {":3: scattering in media is not supported",
                            ":4: cameras of the kind \"orthographic\"",
                            ":5: shapes of the kind \"curve\"",
                            ":7: lights of the kind \"projection\"",
                            ":8: materials of the kind \"subsurface\"",
                            ":10: there is no material of the name \"nobody\"",
                            ":11: Shape \"sphere\": the parameter \"strange\""};
  ASSERT_EQ(desc.warnings.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_CONTAINS(desc.warnings[i], expected[i]);
}

TEST_F(Pbrt, MotionStandsWhereItBegins) {
  const SceneDesc desc = scene(
      "WorldBegin ActiveTransform EndTime Translate 9 0 0 ActiveTransform All Translate 0 1 0\n" + kTriangle);
  EXPECT_EQ(mesh(desc).positions[0], (Vec3{0, 1, 0}));
  EXPECT_EQ(desc.warnings.size(), 1u);
}

TEST_F(Pbrt, ErrorsNameTheFileAndTheLine) {
  const std::string world = "WorldBegin\n";
  expect_error(world + "Shape \"sphere", 2, "no closing quote");
  expect_error(world + "Bogus 1 2 3\n", 2, "found \"Bogus\", expected a directive");
  expect_error(world + "Translate 1 2\nShape \"sphere\"\n", 3, "Translate has 2 numbers and then \"Shape\"");
  expect_error(world + "Translate 1 2 nan\n", 2, "\"nan\" is not a number");
  expect_error(world + "Translate 1 2 1e39\n", 2, "\"1e39\" is not a number that a float can hold");
  expect_error(world + "Transform [1 2 3]\n", 2, "Transform has 3 numbers");
  expect_error(world + "Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]\n", 2, "not affine");
  expect_error(world + "Rotate 90 0 0 0\n", 2, "no length");
  expect_error("LookAt 1 1 1 1 1 1 0 1 0\n", 1, "no direction");
  expect_error(world + "AttributeEnd\n", 2, "no AttributeBegin");
  expect_error(world + "AttributeBegin\nTransformEnd\n", 3, "AttributeBegin of line 2 is still open");
  expect_error(world + kTriangle + "AttributeBegin\n\n\n", 3, "never closed");
  expect_error(world + "ObjectInstance \"tree\"\n", 2, "no object of the name \"tree\"");
  expect_error(world + "ObjectBegin \"a\"\nObjectBegin \"b\"\n", 3, "inside of another object");
  expect_error(world + "ObjectBegin \"a\"\nObjectInstance \"a\"\n", 3, "inside of an object");
  expect_error(world + "ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\"\n", 3, "already an object");
  expect_error(world + "Shape \"sphere\" \"float radius\" [1\n\n", 2, "list without ']'");
  expect_error(world + "Shape \"sphere\" \"float radius\" [1 2]\n", 2, "has 2 numbers, expected 1");
  expect_error(world + "Shape \"sphere\" \"float radius\" \"x\"\n", 2, "expected numbers");
  expect_error(world + "Shape \"sphere\" \"float radius\" -1\n", 2, "radius");
  expect_error(world + "Shape \"sphere\" \"radius\" 1\n", 2, "expected a type and a name");
  expect_error(world + "Shape \"sphere\" \"double radius\" 1\n", 2, "unknown type");
  expect_error(world + "Scale 1 0 1\nShape \"sphere\"\n", 3, "flattens space");
  expect_error(world + "Scale 1e30 1e30 1e30\nScale 1e30 1 1\n" + kTriangle, 4,
               "flattens space or is not finite");
  expect_error(world + "Shape \"trianglemesh\" \"integer indices\" [0 1 3] \"point P\" [0 0 0 1 0 0 0 1 0]\n",
               2, "number 2 is 3");
  expect_error(
      world + "Shape \"trianglemesh\" \"integer indices\" [0 1 -1] \"point P\" [0 0 0 1 0 0 0 1 0]\n", 2,
      "expected the position of one of the 3");
  expect_error(world + "Shape \"trianglemesh\" \"integer indices\" [0 1] \"point P\" [0 0 0 1 0 0 0 1 0]\n",
               2, "multiple of 3");
  expect_error(world + "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1]\n",
               2, "multiple of 3");
  expect_error(world + "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1]\n", 2,
               "1 normals");
  expect_error(world + "Shape \"plymesh\" \"string filename\" \"gone.ply\"\n", 2, "gone.ply");
  expect_error(world + "Include \"gone.pbrt\"\n", 2, "gone.pbrt");
  expect_error("Camera \"perspective\" \"float fov\" 180\n", 1, "\"fov\" is 180");
  expect_error("Scale 0 1 1\nCamera \"perspective\"\n", 2, "flattens space");
  expect_error(world + "LightSource \"spot\" \"point from\" [0 0 1]\n", 2, "no direction");
  expect_error(world + "LightSource \"spot\" \"float coneangle\" -3\n", 2, "a cone of -3");
  expect_error(world + "Shape \"disk\" \"float innerradius\" 2\n", 2, "inner radius is 2");
  expect_error(world + "Shape \"sphere\" \"float phimax\" 0\n", 2, "\"phimax\" is 0");
  expect_error("Film \"image\" \"integer xresolution\" 0\n", 1, "0 by 720");
  EXPECT_CONTAINS(error(world), "no triangle");
}

TEST_F(Pbrt, IncludesThatNeverEndAreErrors) {
  write("a.pbrt", "\nInclude \"b.pbrt\"\n");
  write("b.pbrt", "Include \"a.pbrt\"\n");
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(path("a.pbrt")); }),
                  "b.pbrt:1: includes \"a.pbrt\"");
  write("self.pbrt", "Include \"./self.pbrt\"\n");
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(path("self.pbrt")); }), "in a circle");
  for (int i = 0; i < 70; ++i)
    write("deep" + std::to_string(i) + ".pbrt", "Include \"deep" + std::to_string(i + 1) + ".pbrt\"\n");
  write("deep70.pbrt", kTriangle);
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(path("deep0.pbrt")); }),
                  "more than 64 files are nested");

  // Each file includes the next one twice: 2^40 reads.
  for (int i = 0; i < 40; ++i) {
    const std::string next = "Include \"twice" + std::to_string(i + 1) + ".pbrt\"\n";
    write("twice" + std::to_string(i) + ".pbrt", next + next);
  }
  write("twice40.pbrt", "Identity\n");
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(path("twice0.pbrt")); }), "files are included");
}

/// A scene with some of everything, to be broken.
std::string rich_scene() {
  return "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [48]\n"
         "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [ 35 ]\nWorldBegin\n"
         "Texture \"t\" \"spectrum\" \"scale\" \"rgb tex1\" [.1 .2 .3] \"float tex2\" 2\n"
         "MakeNamedMaterial \"m\" \"string type\" \"metal\" \"spectrum eta\" [400 1 700 2] \"rgb k\" [1 2 "
         "3]\n"
         "AttributeBegin\nTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]\nRotate 30 0 1 0\nMaterial \"matte\" "
         "\"texture Kd\" \"t\"\n"
         "AreaLightSource \"diffuse\" \"blackbody L\" [2700 4]\n" +
         kTriangle +
         "AttributeEnd\nObjectBegin \"o\"\nNamedMaterial \"m\"\nShape \"sphere\" \"float radius\" "
         "2\nObjectEnd\n"
         "Scale 1 2 1\nObjectInstance \"o\"\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
         "LightSource \"distant\" \"point from\" [0 1 0] \"rgb L\" [1 1 1]\nWorldEnd\n";
}

TEST_F(Pbrt, EveryTruncationLoadsOrIsAnErrorWithAPlace) {
  const std::string whole = rich_scene();
  ASSERT_EQ(shown_primitive_count(scene(whole)), 4u);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string message = error(whole.substr(0, length));
    if (!message.empty()) {
      EXPECT_CONTAINS(message, "scene.pbrt:");
    }
  }
}

TEST_F(Pbrt, RandomDamageIsAnErrorOrASceneButNeverACrash) {
  Random random(1);
  const std::string whole = rich_scene();
  const char* words[] = {"\"",       "[",           "]",           "1e38",   "-1e38",          "0",
                         "nan",      "#",           "\\",          "\n",     "AttributeBegin", "ObjectEnd",
                         "Identity", "\"float x\"", "Scale 0 0 0", "1e-300", "99999999999",    "\xff",
                         " "};
  int errors = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = whole;
    for (std::uint32_t edits = 1 + random.below(4); edits > 0; --edits) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(text.size()));
      switch (random.below(4)) {
        case 0:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          text.erase(at, 1 + random.below(20));
          break;
        case 2:
          text.insert(at, words[random.below(std::size(words))]);
          break;
        default:
          text.insert(at,
                      text.substr(random.below(static_cast<std::uint32_t>(text.size())), random.below(40)));
      }
    }
    const std::string message = error(text);
    errors += !message.empty();
    if (!message.empty()) {
      EXPECT_CONTAINS(message, "scene.pbrt:");
    }
  }
  EXPECT_GT(errors, 1000);
}

TEST_F(Pbrt, TheKitchenLoadsWhole) {
  BOXWOOD_NEEDS_MODELS();
  const std::filesystem::path kitchen = std::filesystem::path(models_folder()) / "kitchen" / "scene.pbrt";
  const SceneDesc desc = load(kitchen, &default_executor());
  EXPECT_EQ(defined_primitive_count(desc), 1443517u);
  EXPECT_EQ(shown_primitive_count(desc), 1443517u);
  ASSERT_TRUE(desc.camera);
  EXPECT_EQ(desc.camera->width, 1280);
  EXPECT_GT(determinant(desc.camera->world_from_camera), 0);

  // The floor's picture is not there; nothing else is lost.
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "wood.tga");

  // The lamps shine downwards and the window into the room.
  int lights = 0;
  for (const Geometry& geometry : desc.geometries)
    if (desc.materials[geometry.material.value].emission.x > 0) {
      const Vec3 n = facing(std::get<TriangleMesh>(geometry.shapes));
      EXPECT_TRUE(n.y < -.99f || n.z > .99f);
      ++lights;
    }
  EXPECT_EQ(lights, 4);
}

}  // namespace
}  // namespace boxwood::io
