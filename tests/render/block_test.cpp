// block_test.cpp: do many points at once get what each gets alone, bit for bit?
#include "boxwood/core/block.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/draws.h"
#include "boxwood/render/light.h"
#include "boxwood/render/plain_block.h"
#include "boxwood/render/shadow.h"
#include "boxwood/render/warp.h"
#include "trace.h"

namespace boxwood::render {
namespace {

std::uint32_t any_bits(Random& random) {
  return static_cast<std::uint32_t>(random.uniform() * 65536) << 16 |
         static_cast<std::uint32_t>(random.uniform() * 65536);
}

TEST(Block, DrawsAreThoseOfEachSampler) {
  Random random(3);
  Draws draws;
  std::vector<Sampler> samplers;
  for (int i = 0; i < kBlock; ++i) {
    samplers.emplace_back(any_bits(random), any_bits(random));
    samplers.back().skip(static_cast<std::uint32_t>(i));
    draws.set(i, samplers.back());
  }
  draws.draw();
  for (int i = 0; i < kBlock; ++i)
    for (int k = 0; k < Draws::kAhead; ++k)
      EXPECT_EQ(draws.pair(i, k), samplers[i].next_2d()) << i << " " << k;
}

TEST(Block, TheSecondSobolCoordinateIsThatOfItsDirectionNumbers) {
  Random random(4);
  for (int trial = 0; trial < 1000; ++trial) {
    const std::uint32_t index = any_bits(random);
    std::uint32_t expected = 0, direction = 0x80000000u;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
      if (index >> bit & 1) expected ^= direction;
    EXPECT_EQ(reverse_bits(second_sobol_reversed(index)), expected) << index;
  }
}

TEST(Block, ATurnHasItsSineAndCosine) {
  for (int i = 0; i <= 100000; ++i) {
    const float turn = static_cast<float>(i) / 100000;
    const Vec2 found = turn_sine_cosine(turn);
    const double angle = 2 * 3.14159265358979324 * double(turn);
    ASSERT_NEAR(found.x, std::sin(angle), 3e-7) << turn;
    ASSERT_NEAR(found.y, std::cos(angle), 3e-7) << turn;
  }
}

/// A matte floor and lamps of many kinds: flat ones, round ones, a textured one, points and spots, and, where
/// asked for, lights from far away.
SceneDesc many_lamps(int squares, bool with_others, bool with_far) {
  SceneDesc desc;
  desc.add(std::vector<Quad>{{{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}}});
  Random random(8);
  for (int i = 0; i < squares; ++i) {
    const Vec3 at = random.direction() * 4 + Vec3{0, 5, 0};
    const Vec3 x = random.direction(), y = random.direction() * 0.7f;
    const MaterialId material = desc.add(lamp(1 + 9 * random.uniform(), i % 3 == 0));
    if (i % 2 == 0)
      desc.add(std::vector<Quad>{{at, at + x, at + x + y, at + y}}, material);
    else
      desc.add(std::vector<Cuboid>{{at, at + abs(x) * 0.5f}}, material);
  }
  if (with_others) {
    desc.add(std::vector<Sphere>{{{1, 2, 1}, 0.3f}}, desc.add(lamp(20)));
    desc.add(std::vector<Disk>{{{-1, 3, 1}, {0, -1, 0}, 0.5f}}, desc.add(lamp(20)));
    desc.point_lights.push_back({{0, 4, 3}, splat(100)});
    desc.spot_lights.push_back({{2, 4, 0}, {0, -1, 0}, splat(50), 0.9f, 0.8f});
  }
  if (with_far) desc.distant_lights.push_back({{0, -1, 0}, splat(2)});
  if (with_far) desc.sky = constant_sky(1);
  return desc;
}

TEST(Block, LightsAreThoseThatEachPointTries) {
  for (const int squares : {0, 1, 3, 40})
    for (const bool with_others : {false, true})
      for (const bool with_far : {false, true}) {
        SCOPED_TRACE(testing::Message() << squares << " squares " << with_others << with_far);
        const Scene scene(many_lamps(squares, with_others, with_far));
        const Lights lights(scene, Camera{});
        Random random(5);
        int found_any = 0;
        for (int trial = 0; trial < 40; ++trial) {
          // A block that is not full.
          const int count = trial == 0 ? 1 : kBlock - trial % 3;
          SurfaceBlock surfaces;
          Receivers from;
          Floats choices{};
          Vec2s u;
          std::vector<float> choice_of;
          for (int i = 0; i < count; ++i) {
            Surface surface;
            surface.position = random.direction() * 5 + Vec3{0, 4, 0};
            surface.error = abs(surface.position) * 1e-6f;
            surface.normal = surface.shading_normal = random.direction();
            from.position.set(i, surface.position);
            from.normal.set(i, i % 5 == 0 ? Vec3{0, 0, 0} : i % 2 == 0 ? -surface.normal : surface.normal);
            surfaces.set(i, surface);
            choices[i] = random.uniform();
            choice_of.push_back(choices[i]);
            u.set(i, {random.uniform(), random.uniform()});
          }
          LightSamples found;
          lights.sample(surfaces, count, from, choices, u, found);
          for (int i = 0; i < count; ++i) {
            const auto expected = lights.sample(surfaces[i], from.normal[i], choice_of[i], u[i]);
            ASSERT_EQ(found.pdf[i] > 0, expected.has_value()) << i;
            if (!expected) continue;
            ++found_any;
            EXPECT_EQ(found.pdf[i], expected->pdf);
            EXPECT_EQ(found.direction[i], expected->direction);
            EXPECT_EQ(found.radiance[i], expected->radiance);
            EXPECT_EQ(found.is_perfect[i] != 0, expected->is_perfect);
            EXPECT_EQ(found.shadow_rays[i].origin, expected->shadow_ray.origin);
            EXPECT_EQ(found.shadow_rays[i].direction, expected->shadow_ray.direction);
            EXPECT_EQ(found.shadow_rays[i].t_max, expected->shadow_ray.t_max);
          }
        }
        if (squares + with_others + with_far > 0) {
          EXPECT_GT(found_any, 100);
        }
      }
}

TEST(Block, PlainSurfacesScatterAsABsdfDoes) {
  using Kind = Material::Kind;
  std::vector<Material> materials;
  for (const Vec3 color : {splat(1), Vec3{0.8f, 0.3f, 0}, splat(0.02f)}) {
    materials.push_back(material_of_kind(Kind::matte, color));
    for (const float width : {0.002f, 0.1f, 0.5f, 1.0f})
      for (const float ior : {1.05f, 1.5f, 3.0f}) {
        materials.push_back(material_of_kind(Kind::plastic, color, width));
        materials.back().ior = ior;
      }
  }
  std::vector<PreparedMaterial> prepared(materials.begin(), materials.end());
  Random random(6);
  PlainBlock block;
  int reflected = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Surface, kBlock> surfaces{};
    std::array<Look, kBlock> looks;
    std::vector<Bsdf> bsdfs;
    Vec3s towards;
    Floats choices{};
    Vec2s u;
    for (int i = 0; i < kBlock; ++i) {
      const std::size_t k = static_cast<std::size_t>(random.uniform() * 0.9999f * float(materials.size()));
      ASSERT_TRUE(prepared[k].is_plain);
      surfaces[i].normal = random.direction();
      // Interpolated normals, also such as look away from the viewer.
      const Vec3 bent = normalize(surfaces[i].normal + random.direction() * 0.5f * float(i % 3));
      const Vec3 normal = dot(bent, surfaces[i].normal) > 0 ? bent : surfaces[i].normal;
      const Vec3 outgoing = random.direction();
      looks[i] = look_at(SceneDesc{}, materials[k], prepared[k], TexturePoint(Surface{}));
      bsdfs.emplace_back(looks[i], surfaces[i], normal, outgoing);
      block.set(i, prepared[k], looks[i].color, surfaces[i].normal, normal, outgoing);
      towards.set(i, random.direction());
      choices[i] = random.uniform();
      u.set(i, {random.uniform(), i == 0 ? 0.0f : random.uniform()});
    }
    Scattered scattered;
    block.scatter(towards, choices, u, scattered);
    for (int i = 0; i < kBlock; ++i) {
      const BsdfValue value = bsdfs[i].evaluate(towards[i]);
      EXPECT_EQ(scattered.toward_light(i).value, value.value);
      EXPECT_EQ(scattered.toward_light(i).pdf, value.pdf);
      const auto expected = bsdfs[i].sample(choices[i], u[i]), found = scattered.next(i);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!expected) continue;
      ++reflected;
      EXPECT_EQ(found->direction, expected->direction);
      EXPECT_EQ(found->weight, expected->weight);
      EXPECT_EQ(found->pdf, expected->pdf);
      EXPECT_EQ(found->is_perfect, expected->is_perfect);
      EXPECT_EQ(found->is_transmission, expected->is_transmission);
    }
  }
  EXPECT_GT(reflected, 150 * kBlock);
}

TEST(Block, NoRayThatMeetsAVeilIsTakenForOneThatDoesNot) {
  // Three veils far from the origin, one of them under a transform; rays that run along axes, in the plane of
  // a veil, and anywhere. Whether light gets through is known: half for each veil.
  const Vec3 far{100, 0, -70};
  SceneDesc desc;
  Material half = material_of_kind(Material::Kind::matte, splat(0.5f));
  half.opacity = 0.5f;
  const MaterialId veil = desc.add(half);
  for (int i = 0; i < 3; ++i) {
    const Vec3 at = i == 1 ? Vec3{0, 0, 0} : far + Vec3{float(i), 0, 0};
    Instance instance;
    instance.geometry = desc.add(Geometry{std::vector<Quad>{{at + Vec3{0, -1, -1}, at + Vec3{0, 1, -1},
                                                             at + Vec3{0, 1, 1}, at + Vec3{0, -1, 1}}},
                                          veil,
                                          {},
                                          {}});
    if (i == 1) instance.world_from_object = Affine3::translation(far + Vec3{1, 0, 0});
    desc.add(instance);
  }
  const Scene scene(std::move(desc));
  const Shadows shadows(scene);
  Random random(7);
  constexpr int kTrials = 20000;
  AwaitedLight light(kTrials);
  RayBlock block;
  Integers may_meet_veil{};
  std::vector<float> expected;
  for (int trial = 0; trial < kTrials; ++trial) {
    Vec3 from =
        far + Vec3{4 * random.uniform() - 1, 3 * random.uniform() - 1.5f, 3 * random.uniform() - 1.5f};
    Vec3 to = far + Vec3{4 * random.uniform() - 1, 3 * random.uniform() - 1.5f, 3 * random.uniform() - 1.5f};
    if (trial % 4 == 0) to.y = from.y;
    if (trial % 4 <= 1) to.z = from.z;
    block.set(0, {from, 0, to - from, 1});
    shadows.find_veiled(block, may_meet_veil);
    const auto sample = static_cast<std::uint32_t>(trial);
    if (may_meet_veil[0] != 0)
      light.add_careful(sample, splat(1), block[0], {0, 0, 0});
    else
      light.add(sample, splat(1), block[0]);
    float share = 1;
    for (int i = 0; i < 3; ++i) {
      const float x = far.x + float(i);
      if ((from.x < x) == (to.x < x)) continue;
      const float t = (x - from.x) / (to.x - from.x);
      const Vec3 at = from + (to - from) * t - far;
      const float edge = max(std::fabs(at.y), std::fabs(at.z));
      if (std::fabs(edge - 1) < 1e-3f || t < 1e-3f || t > 1 - 1e-3f) share = -1;  // too near to tell
      if (edge < 1) share *= 0.5f;
    }
    expected.push_back(share);
  }
  std::vector<float> found(3 * expected.size());
  std::vector<RayCounts> rays(expected.size());
  shadows.deliver(light, found, rays);
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (expected[i] > 0) {
      EXPECT_EQ(found[3 * i], expected[i]) << i;
    }
  std::uint32_t asked = 0;
  for (const RayCounts& count : rays) asked += count.shadow;
  EXPECT_GT(asked, 1000u);  // those that cannot meet one are not asked twice
}

}  // namespace
}  // namespace boxwood::render
