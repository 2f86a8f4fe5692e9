// What a pbrt scene becomes, in both versions of the format: its words, places, shapes and cameras.
#include <cmath>

#include "boxwood/scene/scene.h"
#include "io/pbrt_scene.h"

namespace boxwood::io {
namespace {

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

TEST_F(Pbrt, ReadsOverCommasBehindNumbers) {
  const SceneDesc desc = scene(
      "WorldBegin Translate 1, 2, 3 Shape \"trianglemesh\" \"integer indices\" [0, 1, 2] "
      "\"point P\" [0, 0, 0, 1, 0, 0, 0, 1.5, 0,]");
  EXPECT_EQ(mesh(desc).positions, (std::vector<Vec3>{{1, 2, 3}, {2, 2, 3}, {1, 3.5f, 3}}));
  expect_error("WorldBegin Translate 1,2,3 4 5", 1, "\"1,2,3\" is not a number");
  expect_error("WorldBegin Translate , 4 5", 1, "\",\" is not a number");
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

TEST_F(Pbrt, OtherCamerasStandInTheSamePlace) {
  const auto camera = [&](const std::string& text) {
    return *scene(text + " WorldBegin " + kTriangle).camera;
  };
  // Parallel rays: two units across the shorter side, by the scale of the camera's frame.
  EXPECT_EQ(camera("Camera \"orthographic\"").orthographic_size, 2);
  EXPECT_EQ(camera("Scale .5 .5 .5 Camera \"orthographic\"").orthographic_size, 4);
  EXPECT_EQ(camera("Camera \"orthographic\" \"float screenwindow\" [-6 6 -3 3]").orthographic_size, 6);
  EXPECT_EQ(camera("Camera \"perspective\"").orthographic_size, 0);

  // A wider window is a wider angle.
  EXPECT_FLOAT_EQ(camera("Camera \"perspective\" \"float halffov\" 20").fov_deg, 40);
  EXPECT_NEAR(camera("Camera \"perspective\" \"float screenwindow\" [-3 3 -2 2]").fov_deg, 126.8699f, 1e-3f);

  const std::string spherical =
      "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"spherical\" \"string mapping\" \"equalarea\"";
  expect_near(seen(camera(spherical), {1, 2, 0}), {1, 2, 5});
  EXPECT_EQ(scene(spherical + " WorldBegin " + kTriangle).warnings.size(), 1u);
  EXPECT_EQ(camera("Camera \"perspective\" \"float fov\" 80 Camera \"realistic\"").fov_deg, 80);
  expect_error("Camera \"orthographic\" \"float screenwindow\" [1 -1 -1 1]", 1, "left < right");
}

TEST_F(Pbrt, BouncesAreThoseOfTheIntegratorOrFive) {
  EXPECT_EQ(scene("Integrator \"volpath\" \"integer maxdepth\" 17 WorldBegin " + kTriangle).bounces, 17);
  EXPECT_EQ(scene("Integrator \"path\" WorldBegin " + kTriangle).bounces, 5);
  EXPECT_EQ(scene("WorldBegin " + kTriangle).bounces, 5);
  expect_error("\nIntegrator \"path\" \"integer maxdepth\" -1", 2, "expected 0 or more");
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

TEST_F(Pbrt, MotionStandsWhereItBegins) {
  const SceneDesc desc = scene(
      "WorldBegin ActiveTransform EndTime Translate 9 0 0 ActiveTransform All Translate 0 1 0\n" + kTriangle);
  EXPECT_EQ(mesh(desc).positions[0], (Vec3{0, 1, 0}));
  EXPECT_EQ(desc.warnings.size(), 1u);
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
