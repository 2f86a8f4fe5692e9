// What a stereolithography file becomes, text or bytes.
#include <cstring>
#include <map>

#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

using Stl = Files;
using Corners = std::array<Vec3, 3>;

// A cube of 12 triangles, each with corners of its own.
std::vector<Corners> cube() {
  std::vector<Corners> triangles;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto corner = [&](float u, float v) {
        Vec3 p;
        p[axis] = float(side);
        p[(axis + 1) % 3] = side == 1 ? u : v;
        p[(axis + 2) % 3] = side == 1 ? v : u;
        return p;
      };
      triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
      triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
    }
  return triangles;
}

std::string in_bytes(const std::vector<Corners>& triangles, std::string header = "") {
  header.resize(80);
  const auto put = [&](auto value) {
    char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    header.append(bytes, sizeof(value));
  };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const Corners& corners : triangles) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const Vec3 p : corners)
      for (int axis = 0; axis < 3; ++axis) put(p[axis]);
    put(std::uint16_t(0));
  }
  return header;
}

std::string in_text(const std::vector<Corners>& triangles, const std::string& name) {
  std::string text = "solid " + name + "\n";
  for (const Corners& corners : triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const Vec3 p : corners)
      text += "      vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) +
              "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

const TriangleMesh& mesh_of(const SceneDesc& desc, std::size_t geometry = 0) {
  return std::get<TriangleMesh>(desc.geometries.at(geometry).shapes);
}

// Every edge belongs to two triangles, once in each direction.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.indices)
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  return true;
}

TEST_F(Stl, BothKindsJoinEqualCorners) {
  for (const std::string& bytes : {in_bytes(cube()), in_text(cube(), "cube")}) {
    const SceneDesc desc = load(write("a.stl", bytes));
    EXPECT_EQ(mesh_of(desc).positions.size(), 8u);
    EXPECT_EQ(mesh_of(desc).indices.size(), 12u);
    EXPECT_TRUE(is_closed(mesh_of(desc)));
  }
}

TEST_F(Stl, TakesMinusZeroForZero) {
  std::vector<Corners> triangles = cube();
  for (std::size_t i = 0; i < triangles.size(); i += 2)
    for (Vec3& p : triangles[i])
      for (int axis = 0; axis < 3; ++axis)
        if (p[axis] == 0) p[axis] = -0.0f;
  const SceneDesc desc = load(write("a.stl", in_bytes(triangles)));
  EXPECT_EQ(mesh_of(desc).positions.size(), 8u);
  EXPECT_TRUE(is_closed(mesh_of(desc)));
}

TEST_F(Stl, IsNotFooledByAHeaderThatBeginsLikeText) {
  EXPECT_EQ(defined_primitive_count(load(write("a.stl", in_bytes(cube(), "solid made by CAD")))), 12u);
  EXPECT_EQ(defined_primitive_count(load(write("a.stl", in_bytes(cube(), "solid with a facet")))), 12u);
  // Bytes after the last triangle, which some programs leave.
  EXPECT_EQ(defined_primitive_count(load(write("a.stl", in_bytes(cube(), "solid made by CAD") + "tail"))),
            12u);
}

TEST_F(Stl, MakesAGeometryOfEachSolid) {
  const SceneDesc desc = load(write("a.stl", in_text(cube(), "first one") + in_text({cube()[0]}, "second")));
  ASSERT_EQ(desc.geometries.size(), 2u);
  EXPECT_EQ(desc.geometries[0].name, "first one");
  EXPECT_EQ(desc.geometries[1].name, "second");
  EXPECT_EQ(mesh_of(desc, 1).positions.size(), 3u);
}

TEST_F(Stl, SaysWhereAFileIsWrong) {
  std::string cut = in_bytes(cube()), nan = in_bytes(cube());
  cut.resize(cut.size() - 1);
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 84 + 50 + 12, &not_a_number, 4);
  std::string huge = in_bytes(cube());
  huge.replace(80, 4, "\xff\xff\xff\xff");
  const std::string facet = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  const struct {
    std::string bytes, expected;
  } cases[] = {
      {cut, "a.stl:byte 80: the header tells of 12 triangles, but the file has bytes for 11"},
      {huge, "tells of 4294967295 triangles"},
      {nan, "a.stl: scene: geometry 0, vertex"},
      {std::string(50, 'x'), "a.stl:byte 50: the file ends within the header"},
      {in_bytes({}), "there is no triangle"},
      {"solid nothing\nendsolid nothing\n", "there is no triangle"},
      {facet, "a.stl:line 5: the file ends before its 'endsolid'"},
      {facet + "endloop\nendfacet\nendsolid a\n", "line 7: a facet has 2 vertices, expected 3"},
      {facet + "vertex 0 1 0\nvertex 0 1 0\nendfacet\nendsolid a\n",
       "line 7: a facet has more than 3 vertices"},
      {facet + "vertex 0 nan 0\nendfacet\nendsolid a\n",
       "line 6: a vertex has 'nan', expected a finite number"},
      {facet + "vertex 0 1 1e40\nendfacet\nendsolid a\n", "line 6: a vertex has '1e40'"},
      {facet + "vertex 0 1 0\nendloop\nfacet normal 0 0 1\n", "line 8: 'facet' comes before the 'endfacet'"},
      {facet + "vortex 0 1 0\nendsolid a\n", "line 6: 'vortex' is not a word of this format"},
  };
  for (const auto& [bytes, expected] : cases) {
    const auto file = write("a.stl", bytes);
    EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }), expected);
  }
}

}  // namespace
}  // namespace boxwood::io
