// Equal descriptions share a fingerprint, and whatever can be seen changes it.
#include "boxwood/scene/fingerprint.h"

#include <set>

#include <gtest/gtest.h>

#include "boxwood/gallery/gallery.h"

namespace boxwood {
namespace {

TEST(Fingerprint, OfEqualDescriptionsIsEqual) {
  EXPECT_EQ(fingerprint(gallery::make("stilllife")), fingerprint(gallery::make("stilllife")));
  SceneDesc named = gallery::make("soup:10");
  const std::uint64_t before = fingerprint(named);
  named.geometries[0].name = "another";  // cannot be seen
  EXPECT_EQ(fingerprint(named), before);
}

// Empty arrays have no address; the sanitizers see that nobody reads there.
TEST(Fingerprint, OfWhatIsEmptyIsOneOfItsOwn) {
  SceneDesc nothing, empty_mesh, no_balls;
  empty_mesh.add(TriangleMesh{});
  no_balls.add(std::vector<Sphere>{});
  const std::set<std::uint64_t> all{fingerprint(nothing), fingerprint(empty_mesh), fingerprint(no_balls)};
  EXPECT_EQ(all.size(), 3u);
}

TEST(Fingerprint, ChangesWithWhatCanBeSeen) {
  const SceneDesc original = gallery::make("soup:10");
  std::set<std::uint64_t> all{fingerprint(original)};
  const auto add = [&](auto change) {
    SceneDesc changed = original;
    change(changed, std::get<TriangleMesh>(changed.geometries[0].shapes));
    all.insert(fingerprint(changed));
  };
  add([](SceneDesc&, TriangleMesh& mesh) { mesh.positions[3].y = -mesh.positions[3].y; });
  add([](SceneDesc&, TriangleMesh& mesh) { std::swap(mesh.indices[1], mesh.indices[2]); });
  add([](SceneDesc&, TriangleMesh& mesh) { mesh.uvs.resize(mesh.positions.size()); });
  add([](SceneDesc&, TriangleMesh& mesh) { mesh.second_uvs.resize(mesh.positions.size()); });
  add([](SceneDesc&, TriangleMesh& mesh) { mesh.colors.resize(mesh.positions.size()); });
  add([](SceneDesc&, TriangleMesh& mesh) { mesh.indices.pop_back(); });
  add([](SceneDesc& desc, TriangleMesh&) { desc.add(Instance{GeometryId(0), Affine3::scale(2), {}}); });
  EXPECT_EQ(all.size(), 8u);
}

}  // namespace
}  // namespace boxwood
