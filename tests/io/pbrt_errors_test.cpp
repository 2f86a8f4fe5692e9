// What the pbrt reader says of what it does not support, and of what is broken.
#include "boxwood/core/random.h"
#include "io/pbrt_scene.h"

namespace boxwood::io {
namespace {

TEST_F(Pbrt, WhatIsNotSupportedIsNamedOnceAndTheRestLoads) {
  const SceneDesc desc = scene(
      "Option \"bool disablewavelengthjitter\" true ColorSpace \"srgb\"\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4 Integrator \"path\" PixelFilter \"box\" Accelerator "
      "\"bvh\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\"\n"
      "Camera \"realistic\" \"string lensfile\" \"wide.dat\" WorldBegin\n"
      "Shape \"curve\" \"float radius\" 1\nShape \"curve\"\n"
      "LightSource \"projection\" LightSource \"projection\"\n"
      "Material \"subsurface\" \"rgb reflectance\" [.4 .4 .4]\nMaterial \"subsurface\"\n"
      "NamedMaterial \"nobody\"\n"
      "Attribute \"shape\" \"float radius\" 5 Shape \"sphere\" \"bool strange\" true\n");
  EXPECT_EQ(std::get<std::vector<Sphere>>(desc.geometries.at(0).shapes)[0].radius, 5);
  const char* expected[] = {":3: scattering in media is not supported",
                            ":4: cameras of the kind \"realistic\"",
                            ":5: shapes of the kind \"curve\"",
                            ":7: lights of the kind \"projection\"",
                            ":8: materials of the kind \"subsurface\"",
                            ":10: there is no material of the name \"nobody\"",
                            ":11: Shape \"sphere\": the parameter \"strange\""};
  ASSERT_EQ(desc.warnings.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_CONTAINS(desc.warnings[i], expected[i]);
}

TEST_F(Pbrt, MistakesThatPbrtForgivesAreWarnings) {
  const SceneDesc desc = scene(
      "WorldBegin Transform [1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1]\n" + kTriangle + "Identity ObjectBegin \"a\" " +
      kTriangle + "ObjectEnd\nObjectBegin \"a\" Shape \"sphere\" ObjectEnd\nObjectInstance \"a\"\n" +
      "Shape \"trianglemesh\" \"point P\" [] \"integer indices\" []\n");
  ASSERT_EQ(desc.geometries.size(), 2u);
  EXPECT_EQ(mesh(desc).positions[1], (Vec3{1, 0, 0}));
  EXPECT_TRUE(std::holds_alternative<std::vector<Sphere>>(desc.geometries[1].shapes));  // the second "a"
  ASSERT_EQ(desc.warnings.size(), 3u);
  EXPECT_CONTAINS(desc.warnings[0], ":1: Transform is not affine");
  EXPECT_CONTAINS(desc.warnings[1], ":5: there is already an object of the name \"a\"");
  EXPECT_CONTAINS(desc.warnings[2], ":7: a mesh without vertices");
}

TEST_F(Pbrt, OfAParameterThatIsGivenTwiceTheLastCounts) {
  const SceneDesc desc = scene(
      "WorldBegin Attribute \"shape\" \"float radius\" 4\n"
      "Shape \"sphere\" \"float radius\" 2 \"float radius\" 3\n");
  EXPECT_EQ(std::get<std::vector<Sphere>>(desc.geometries.at(0).shapes)[0].radius, 3);
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, ErrorsNameTheFileAndTheLine) {
  const std::string world = "WorldBegin\n";
  expect_error(world + "Shape \"sphere", 2, "no closing quote");
  expect_error(world + "Bogus 1 2 3\n", 2, "found \"Bogus\", expected a directive");
  expect_error(world + "Translate 1 2\nShape \"sphere\"\n", 3, "Translate has 2 numbers and then \"Shape\"");
  expect_error(world + "Translate 1 2 nan\n", 2, "\"nan\" is not a number");
  expect_error(world + "Translate 1 2 1e39\n", 2, "\"1e39\" is not a number that a float can hold");
  expect_error(world + "Transform [1 2 3]\n", 2, "Transform has 3 numbers");
  expect_error(world + "Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 0]\n", 2, "not affine");
  expect_error(world + "Rotate 90 0 0 0\n", 2, "no length");
  expect_error("LookAt 1 1 1 1 1 1 0 1 0\n", 1, "no direction");
  expect_error(world + "AttributeEnd\n", 2, "no AttributeBegin");
  expect_error(world + "AttributeBegin\nTransformEnd\n", 3, "AttributeBegin of line 2 is still open");
  expect_error(world + kTriangle + "AttributeBegin\n\n\n", 3, "never closed");
  expect_error(world + "ObjectInstance \"tree\"\n", 2, "no object of the name \"tree\"");
  expect_error(world + "ObjectBegin \"a\"\nObjectBegin \"b\"\n", 3, "inside of another object");
  expect_error(world + "ObjectBegin \"a\"\nObjectInstance \"a\"\n", 3, "inside of an object");
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

TEST_F(Pbrt, AnIncludeMayBeEmpty) {
  write("extra.pbrt", "");
  EXPECT_EQ(scene("WorldBegin Include \"extra.pbrt\" Shape \"sphere\"").geometries.size(), 1u);
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

}  // namespace
}  // namespace boxwood::io
