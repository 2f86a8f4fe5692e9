// Pictures as a whole: the same bits for any threads, stops, limits, and scenes of nothing.
#include "boxwood/render/render.h"

#include <atomic>
#include <cstring>

#include <gtest/gtest.h>

#include "boxwood/render/camera.h"
#include "trace.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

/// A bit of everything: lamps, a sky with a sun, every kind of material.
SceneDesc small_scene() {
  SceneDesc desc;
  const MaterialId floor = desc.add(material_of_kind(Kind::matte, {0.6f, 0.5f, 0.4f}));
  desc.add(std::vector<Quad>{{{-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}}}, floor);
  const Material kinds[] = {
      material_of_kind(Kind::matte, {0.9f, 0.2f, 0.1f}), material_of_kind(Kind::mirror, splat(0.9f)),
      material_of_kind(Kind::glass, splat(1)), material_of_kind(Kind::metal, {1, 0.8f, 0.3f}, 0.2f),
      material_of_kind(Kind::plastic, {0.1f, 0.3f, 0.8f}, 0.05f)};
  float x = -3;
  for (const Material& material : kinds) {
    desc.add(std::vector<Sphere>{{{x, 0.7f, 0}, 0.7f}}, desc.add(material));
    x += 1.5f;
  }
  desc.add(std::vector<Disk>{{{0, 4, 2}, {0, -1, 0}, 1}}, desc.add(lamp(6)));
  desc.sky = constant_sky(0.2f);
  desc.sky->sun_direction = normalize(Vec3{1, 2, 1});
  desc.sky->sun_radiance = splat(500);
  return desc;
}

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

/// Runs everything on the calling thread, last things first.
class BackwardExecutor final : public Executor {
 public:
  int concurrency() const override { return 1; }
  void for_range(std::size_t begin, std::size_t end, std::size_t, const Range& body) override {
    while (end > begin) {
      body(end - 1, end);
      --end;
    }
  }
  void both(const Task& first, const Task& second) override {
    second();
    first();
  }
};

TEST(Render, AFilterWithNegativeLobesLeavesNoPixelBlack) {
  // Everywhere is the same light, so however few samples there are, their mean is that light.
  SceneDesc desc;
  desc.sky = constant_sky(1);
  const Scene scene(desc);
  for (const int samples : {2, 3, 4, 8, 32}) {
    RenderOptions options;
    options.width = options.height = 40;
    options.samples = samples;
    options.filter = Filter::mitchell;
    for (const float value : render_picture(scene, options).image.pixels) ASSERT_EQ(value, 1) << samples;
  }
}

TEST(Render, SameBitsForAnyThreadsAndAnyOrderOfTiles) {
  const Scene scene(small_scene());
  for (const Mode mode : {Mode::path, Mode::color, Mode::normal, Mode::depth, Mode::occlusion, Mode::cost}) {
    RenderOptions options;
    options.mode = mode;
    options.width = 75;
    options.height = 41;
    options.samples = 7;
    options.executor = &serial_executor();
    const RenderResult expected = render_picture(scene, options);
    for (const int threads : {2, 5}) {
      const auto executor = make_executor(threads);
      options.executor = executor.get();
      const RenderResult found = render_picture(scene, options);
      EXPECT_TRUE(same_bits(found.image, expected.image))
          << mode_name(mode) << " with " << threads << " threads";
      EXPECT_EQ(found.rays, expected.rays);
    }
    BackwardExecutor backward;
    options.executor = &backward;
    EXPECT_TRUE(same_bits(render_picture(scene, options).image, expected.image))
        << mode_name(mode) << " backward";
  }
}

TEST(Render, NothingThatIsNotFiniteReachesThePicture) {
  const Scene scene(small_scene());
  for (const Mode mode : {Mode::path, Mode::color, Mode::normal, Mode::depth, Mode::occlusion, Mode::cost}) {
    RenderOptions options;
    options.mode = mode;
    options.width = 120;
    options.height = 60;
    options.samples = 16;
    const RenderResult result = render_picture(scene, options);
    for (const float value : result.image.pixels) ASSERT_TRUE(std::isfinite(value)) << mode_name(mode);
    EXPECT_EQ(result.dropped_samples, 0u) << mode_name(mode);
    for (const float value : displayable(result.image, mode).pixels)
      ASSERT_TRUE(std::isfinite(value) && value >= 0);
  }
}

TEST(Render, EmptyAndDegenerateScenes) {
  SceneDesc point;
  point.add(TriangleMesh{{{7, 8, 9}, {7, 8, 9}, {7, 8, 9}}, {{0, 1, 2}}, {}, {}});
  for (const SceneDesc& desc : {SceneDesc{}, point}) {
    const Scene scene(desc);
    for (const Mode mode :
         {Mode::path, Mode::color, Mode::normal, Mode::depth, Mode::occlusion, Mode::cost}) {
      RenderOptions options;
      options.mode = mode;
      options.width = options.height = 9;
      options.samples = 2;
      const RenderResult result = render_picture(scene, options);
      EXPECT_TRUE(result.is_complete);
      for (const float value : displayable(result.image, mode).pixels) EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST(Render, AStopKeepsWhatThereIs) {
  const Scene scene(small_scene());
  RenderOptions options;
  options.mode = Mode::color;
  options.width = 64;
  options.height = 48;
  options.samples = 1024;
  options.executor = &serial_executor();
  int calls = 0;
  options.progress = [&](const RenderStatus& status) {
    EXPECT_GE(status.done, 0);
    EXPECT_LE(status.done, 1);
    return ++calls < 15;  // one pass is 12 tiles
  };
  const RenderResult result = render_picture(scene, options);
  EXPECT_FALSE(result.is_complete);
  EXPECT_EQ(calls, 15);
  for (std::size_t i = 0; i < result.image.pixels.size(); i += 3)
    ASSERT_GT(result.image.pixels[i] + result.image.pixels[i + 1] + result.image.pixels[i + 2], 0)
        << "pixel " << i / 3;
}

TEST(Render, ProgressGrowsToOne) {
  const Scene scene(small_scene());
  RenderOptions options;
  options.width = options.height = 20;
  options.samples = 5;
  options.executor = &serial_executor();
  double last = 0;
  options.progress = [&](const RenderStatus& status) {
    EXPECT_GT(status.done, last);
    last = status.done;
    return true;
  };
  EXPECT_TRUE(render_picture(scene, options).is_complete);
  EXPECT_DOUBLE_EQ(last, 1);
}

TEST(Render, RefusesSizesAndSamplesOutOfRange) {
  const Scene scene(SceneDesc{});
  const auto refused = [&](int width, int height, int samples) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    EXPECT_THROW(render_picture(scene, options), std::invalid_argument)
        << width << "x" << height << ", " << samples;
  };
  refused(0, 0, 1);
  refused(0, 10, 1);
  refused(10, -1, 1);
  refused(1000000000, 1000000000, 1);
  refused(32768, 32768, 1);
  refused(10, 10, 0);
  refused(10, 10, 1 << 30);
}

TEST(Render, ModesHaveNames) {
  for (const Mode mode : {Mode::path, Mode::color, Mode::normal, Mode::depth, Mode::occlusion, Mode::cost})
    EXPECT_EQ(mode_from_name(mode_name(mode)), mode);
  EXPECT_THROW(mode_from_name("fog"), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood::render
