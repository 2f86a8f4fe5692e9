// gallery_test.cpp: are the made scenes what their names promise, and the same each time?

#include "boxwood/gallery/gallery.h"

#include <cstring>
#include <stdexcept>

#include <gtest/gtest.h>

namespace boxwood::gallery {
namespace {

/// FNV-1a over the bytes of a vector of plain data.
template <class T>
std::uint64_t hash_of(const std::vector<T>& values, std::uint64_t hash) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ull;
  return hash;
}

std::uint64_t hash_of(const SceneDesc& desc) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const Geometry& geometry : desc.geometries) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
      hash = hash_of(mesh->positions, hash);
      hash = hash_of(mesh->indices, hash);
      hash = hash_of(mesh->normals, hash);
      hash = hash_of(mesh->uvs, hash);
    } else if (const auto* spheres = std::get_if<std::vector<Sphere>>(&geometry.shapes)) {
      hash = hash_of(*spheres, hash);
    } else if (const auto* quads = std::get_if<std::vector<Quad>>(&geometry.shapes)) {
      hash = hash_of(*quads, hash);
    } else if (const auto* cuboids = std::get_if<std::vector<Cuboid>>(&geometry.shapes)) {
      hash = hash_of(*cuboids, hash);
    } else {
      ADD_FAILURE() << "the hash does not know this kind of shape";
    }
    hash = hash_of(geometry.materials, hash);
  }
  for (const Texture& texture : desc.textures) hash = hash_of(texture.texels, hash);
  return hash;
}

Box3 bounds_of(const SceneDesc& desc) {
  Box3 bounds;
  for (const Geometry& geometry : desc.geometries)
    std::visit(
        [&bounds](const auto& shapes) {
          if constexpr (std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>) {
            for (const Vec3 p : shapes.positions) bounds.extend(p);
          } else {
            for (const auto& shape : shapes) bounds.extend(shape.box());
          }
        },
        geometry.shapes);
  return bounds;
}

/// Small enough for a test to make each.
std::vector<std::string> sample_names() {
  return {"stilllife", "cornell",   "spheres:1", "spheres:500",  "soup:1",
          "soup:3000", "terrain:1", "terrain:2", "terrain:3",    "terrain:100",
          "city:1",    "city:7",    "city:900",  "duplicates:1", "duplicates:50"};
}

std::string message_of(std::string_view name) {
  try {
    make(name);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Gallery, MakesValidScenes) {
  for (const std::string& name : sample_names()) {
    SCOPED_TRACE(name);
    const SceneDesc desc = make(name);
    EXPECT_EQ(desc.name, name);
    EXPECT_NO_THROW(check(desc));
    const Box3 bounds = bounds_of(desc);
    EXPECT_FALSE(bounds.is_empty());
    EXPECT_TRUE(is_finite(bounds.lower) && is_finite(bounds.upper));
    EXPECT_TRUE(desc.warnings.empty());
  }
}

TEST(Gallery, CanBePhotographed) {
  for (const std::string& name : sample_names()) {
    SCOPED_TRACE(name);
    const SceneDesc desc = make(name);
    ASSERT_TRUE(desc.camera.has_value());
    EXPECT_GT(desc.camera->width, 0);
    EXPECT_GT(desc.camera->height, 0);
    EXPECT_GT(desc.camera->fov_deg, 0);

    // There is light, from the sky or from a lamp.
    bool has_lamp = desc.sky.has_value();
    for (const Material& material : desc.materials) has_lamp |= max_component(material.emission) > 0;
    EXPECT_TRUE(has_lamp);
    if (desc.sky) {
      EXPECT_NEAR(length(desc.sky->sun_direction), 1, 1e-6);
    }

    // Every primitive has a material.
    for (const Geometry& geometry : desc.geometries)
      EXPECT_TRUE(geometry.material.is_valid() || geometry.materials.size() == primitive_count(geometry));
  }
}

TEST(Gallery, CountsAreAsAsked) {
  const auto count = [](std::string_view name) { return shown_primitive_count(make(name)); };
  EXPECT_EQ(count("spheres:1"), 1u);
  EXPECT_EQ(count("spheres:1234"), 1234u);
  EXPECT_EQ(count("soup:777"), 777u);
  EXPECT_EQ(count("duplicates:321"), 321u);
  EXPECT_EQ(count("terrain:1"), 2u);
  EXPECT_EQ(count("terrain:33"), 2u * 33 * 33);
  EXPECT_EQ(count("city:17"), 17u + 1) << "the towers and the ground";
  EXPECT_EQ(count("cornell"), 3u + 1 + 1 + 5 + 5 + 1);
  EXPECT_GT(count("stilllife"), 7381u + 60'000) << "the flake and the pot alone have as many";
}

TEST(Gallery, DefaultSizesWork) {
  for (const Entry& entry : entries()) {
    SCOPED_TRACE(entry.name);
    EXPECT_TRUE(is_known(entry.name));
    EXPECT_FALSE(entry.description.empty());
    EXPECT_LE(entry.default_size, entry.max_size);
    const std::string full = entry.default_size == 0
                                 ? std::string(entry.name)
                                 : std::string(entry.name) + ":" + std::to_string(entry.default_size);
    EXPECT_EQ(make(entry.name).name, full);
  }
}

TEST(Gallery, SameBitsEachTime) {
  for (const std::string& name : sample_names()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(hash_of(make(name)), hash_of(make(name)));
  }
  EXPECT_NE(hash_of(make("soup:100")), hash_of(make("soup:101")));
}

TEST(Gallery, SoupHasSmallAndHugeTriangles) {
  const SceneDesc desc = make("soup:20000");
  const auto& mesh = std::get<TriangleMesh>(desc.geometries[0].shapes);
  std::vector<float> reach;
  for (const auto& [a, b, c] : mesh.indices) {
    Box3 box;
    for (const std::uint32_t vertex : {a, b, c}) box.extend(mesh.positions[vertex]);
    reach.push_back(max_component(box.upper - box.lower));
  }
  std::sort(reach.begin(), reach.end());
  const float cell = 2 / std::cbrt(20000.0f), median = reach[reach.size() / 2];
  EXPECT_GT(median, 0.1f * cell);
  EXPECT_LT(median, cell);
  EXPECT_GT(reach.back(), 8 * median);
}

TEST(Gallery, CloudsFillTheCubeAndStayInside) {
  for (const char* name : {"spheres:100", "spheres:5000", "soup:100", "soup:5000"}) {
    SCOPED_TRACE(name);
    const Box3 bounds = bounds_of(make(name));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(bounds.lower[axis], -1.0001f);
      EXPECT_LE(bounds.upper[axis], 1.0001f);
      EXPECT_LT(bounds.lower[axis], -0.6f);
      EXPECT_GT(bounds.upper[axis], 0.6f);
    }
  }
}

TEST(Gallery, DuplicatesAreAllTheSame) {
  const SceneDesc desc = make("duplicates:100");
  const auto& mesh = std::get<TriangleMesh>(desc.geometries[0].shapes);
  for (const auto& triangle : mesh.indices) EXPECT_EQ(triangle, mesh.indices[0]);
}

TEST(Gallery, TowersAreLongAndThinAndStandApart) {
  const SceneDesc desc = make("city:400");
  const auto& towers = std::get<std::vector<Cuboid>>(desc.geometries[0].shapes);
  double slenderness = 0;
  for (std::size_t i = 0; i < towers.size(); ++i) {
    const Vec3 size = towers[i].upper - towers[i].lower;
    EXPECT_GT(min_component(size), 0);
    slenderness += size.y / max(size.x, size.z);
    for (std::size_t k = i + 1; k < towers.size(); ++k) {
      const bool apart_in_x = towers[i].upper.x < towers[k].lower.x || towers[k].upper.x < towers[i].lower.x;
      const bool apart_in_z = towers[i].upper.z < towers[k].lower.z || towers[k].upper.z < towers[i].lower.z;
      EXPECT_TRUE(apart_in_x || apart_in_z) << i << " and " << k;
    }
  }
  EXPECT_GT(slenderness / double(towers.size()), 3);
}

TEST(Gallery, TerrainIsTheSameIslandAtAnySize) {
  const SceneDesc coarse_desc = make("terrain:64"), fine_desc = make("terrain:128");
  const auto& coarse = std::get<TriangleMesh>(coarse_desc.geometries[0].shapes);
  const auto& fine = std::get<TriangleMesh>(fine_desc.geometries[0].shapes);
  double difference = 0, highest = 0;
  for (std::size_t j = 0; j <= 64; ++j)
    for (std::size_t i = 0; i <= 64; ++i) {
      const Vec3 a = coarse.positions[j * 65 + i], b = fine.positions[2 * j * 129 + 2 * i];
      EXPECT_EQ(a.x, b.x);
      EXPECT_EQ(a.z, b.z);
      difference += std::fabs(a.y - b.y) / (65 * 65);
      highest = std::max(highest, double(a.y));
    }
  EXPECT_LT(difference, 0.05 * highest) << "only one finer octave lies between them";
}

TEST(Gallery, TerrainNormalsPointUp) {
  const SceneDesc desc = make("terrain:50");
  for (const Vec3 n : std::get<TriangleMesh>(desc.geometries[0].shapes).normals) {
    EXPECT_NEAR(length(n), 1, 1e-5);
    EXPECT_GT(n.y, 0);
  }
}

TEST(Gallery, CornellBoxFacesInward) {
  const SceneDesc desc = make("cornell");
  const Vec3 middle{278, 274, 280};
  for (const Geometry& geometry : desc.geometries) {
    const bool is_block = geometry.name.find("block") != std::string::npos;
    const auto& quads = std::get<std::vector<Quad>>(geometry.shapes);
    Box3 box;
    for (const Quad& quad : quads) box.extend(quad.box());
    const Vec3 inside = is_block ? (box.lower + box.upper) * 0.5f : middle;
    for (const Quad& quad : quads)
      for (const std::uint32_t part : {0u, 1u}) {
        const float facing = dot(quad.half(part).normal(), inside - (quad.a + quad.c) * 0.5f);
        EXPECT_EQ(facing > 0, !is_block) << geometry.name;
      }
  }
}

TEST(GalleryNames, UnknownNamesListTheKnownOnes) {
  for (const char* name : {"", ":", "teapot", "Soup:10", "soup 10", "soup.obj", ":100"}) {
    SCOPED_TRACE(name);
    const std::string message = message_of(name);
    for (const Entry& entry : entries()) EXPECT_NE(message.find(entry.name), std::string::npos) << message;
  }
  EXPECT_FALSE(is_known("soup:10"));
  EXPECT_FALSE(is_known(""));
}

TEST(GalleryNames, SizesMustBeWholeNumbersInRange) {
  for (const char* name :
       {"soup:", "soup:0", "soup:-1", "soup:+5", "soup: 5", "soup:5 ", "soup:1e3", "soup:5x", "soup:0x10",
        "soup:2.5", "soup:nan", "soup:20000001", "soup:99999999999999999999999", "soup:1:2", "terrain:4097",
        "city:", "duplicates:abc", "spheres:10000001"}) {
    SCOPED_TRACE(name);
    const std::string message = message_of(name);
    EXPECT_NE(message.find("expected a whole number from 1 to "), std::string::npos) << message;
  }
  EXPECT_NE(message_of("terrain:x").find("4096"), std::string::npos);
}

TEST(GalleryNames, ScenesWithoutSizeTakeNone) {
  EXPECT_NE(message_of("cornell:5").find("has no size"), std::string::npos);
  EXPECT_NE(message_of("stilllife:").find("has no size"), std::string::npos);
}

}  // namespace
}  // namespace boxwood::gallery
