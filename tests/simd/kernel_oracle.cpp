#include "kernel_oracle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/reference/brute_force.h"
#include "boxwood/simd/validate.h"
#include "boxwood/tree/collapse.h"

namespace boxwood::simd::test {
namespace {

template <int W>
std::unique_ptr<TriangleTree> pack_as(const Bvh& bvh, std::span<const Triangle> triangles,
                                      std::span<const std::uint32_t> keys, Layout layout,
                                      WideCost cost = {}) {
  return std::make_unique<TriangleTree>(collapse<W>(bvh, serial_executor(), cost), triangles, keys,
                                        serial_executor(), layout);
}

struct PackedTree {
  std::string name;
  std::unique_ptr<TriangleTree> tree;
};

/// The trees of every method, of the presets, and wide trees with small leaves and with large ones; in every
/// layout.
std::vector<PackedTree> every_packed_tree(int width, std::span<const Triangle> triangles,
                                          std::span<const std::uint32_t> keys) {
  const std::vector<Box3> all = boxes(triangles);
  std::vector<boxwood::test::NamedTree> trees = boxwood::test::every_tree(all);
  for (const auto& [name, options] :
       {std::pair{"fast", BuildOptions::fast()}, std::pair{"balanced", BuildOptions::balanced()},
        std::pair{"best", BuildOptions::best()}})
    trees.push_back({name, build(all, options)});

  std::vector<PackedTree> packed;
  const auto add = [&](const std::string& name, const Bvh& bvh, WideCost cost) {
    for (const Layout layout : kLayouts) {
      packed.push_back(
          {name + (layout == Layout::full ? "" : ", compact"), with_width(width, [&, &bvh = bvh](auto w) {
             return pack_as<w()>(bvh, triangles, keys, layout, cost);
           })});
      EXPECT_EQ(validate(*packed.back().tree), "") << packed.back().name;
    }
  };
  for (const auto& [name, bvh] : trees) add(name, bvh, {});
  const Bvh fine = build(all, {.leaf_size = 1});
  add("small leaves", fine, {.node = 0.01f, .block = 10});
  add("large leaves", fine, {.node = 100, .block = 0.01f});
  return packed;
}

bool equals(const TriangleHit& hit, const Answer& expected, const TriangleTree& tree) {
  if (expected.crossings.empty()) return !hit.is_hit() && hit.t == kInfinity && hit.key == TriangleHit::kNone;
  const auto [t, key] = expected.crossings.front();
  return hit.is_hit() && same_bits(hit.t, t) && hit.key == key && hit.lane < kBlockWidth &&
         tree.key(hit.block, hit.lane) == key;
}

bool same_hit(const TriangleHit& a, const TriangleHit& b) {
  return same_bits(a.t, b.t) && a.key == b.key && a.is_hit() == b.is_hit() &&
         (!a.is_hit() || (a.block == b.block && a.lane == b.lane));
}

/// What no kernel answers, to see that it was left alone.
constexpr TriangleHit kUntouched{-7, 77, 777, 3};

/// Fails with what the ray was; the first few times.
class Complaints {
 public:
  explicit Complaints(std::string where) : where_(std::move(where)) {}
  void operator()(const Ray& ray, std::size_t i, const char* what) {
    if (++count_ > 3) return;
    const auto text = [](Vec3 v) {
      return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
    };
    ADD_FAILURE() << where_ << ": " << what << ", ray " << i << " from " << text(ray.origin) << " along "
                  << text(ray.direction) << " for t in [" << ray.t_min << ", " << ray.t_max << "]";
  }

 private:
  std::string where_;
  int count_ = 0;
};

}  // namespace

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

std::unique_ptr<TriangleTree> pack(int width, const Bvh& bvh, std::span<const Triangle> triangles,
                                   std::span<const std::uint32_t> keys, Layout layout) {
  return with_width(width, [&](auto w) { return pack_as<w()>(bvh, triangles, keys, layout); });
}

std::vector<Answer> brute_answers(std::span<const Triangle> triangles, std::span<const std::uint32_t> keys,
                                  std::span<const Ray> rays) {
  const reference::BruteForce<Triangle> brute(triangles);
  std::vector<Answer> answers;
  std::vector<ShapeHit> hits;
  for (const Ray& ray : rays) {
    brute.all_hits(ray, hits);
    Answer& answer = answers.emplace_back();
    for (const ShapeHit& hit : hits)
      answer.crossings.push_back({hit.t, keys.empty() ? hit.prim_id.value : keys[hit.prim_id.value]});
    std::sort(answer.crossings.begin(), answer.crossings.end());
    answer.crossings.erase(std::unique(answer.crossings.begin(), answer.crossings.end()),
                           answer.crossings.end());
  }
  return answers;
}

std::vector<bool> expect_batch_equals_single(const Kernels& kernels, const TriangleTree& tree,
                                             std::span<const Ray> rays, const Box3& bounds) {
  Complaints complain(std::string(kernels.name) + ", batch of " + std::to_string(rays.size()));

  // The lists of unusual rays are added to, not written anew.
  constexpr std::uint32_t kBefore = 12345;
  std::vector<std::uint32_t> unusual_closest{kBefore}, unusual_any{kBefore};
  std::vector<TriangleHit> hits(rays.size(), kUntouched);
  const auto any =
      std::make_unique<bool[]>(2 * rays.size() + 1);  // twice: prefilled with false and with true
  std::fill_n(any.get() + rays.size(), rays.size(), true);
  kernels.closest_hits(tree, rays, bounds, hits.data(), nullptr, unusual_closest);
  kernels.any_hits(tree, rays, bounds, any.get(), unusual_any);
  std::vector<std::uint32_t> again;
  kernels.any_hits(tree, rays, bounds, any.get() + rays.size(), again);

  std::vector<bool> handed_back(rays.size(), false);
  std::vector<std::uint32_t> expected_unusual;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    TriangleHit hit = kUntouched;
    bool is_hit = false, is_hit_too = true;
    handed_back[i] = !kernels.closest_hit(tree, rays[i], bounds, hit);
    if (kernels.any_hit(tree, rays[i], bounds, is_hit) == handed_back[i] ||
        kernels.any_hit(tree, rays[i], bounds, is_hit_too) == handed_back[i])
      complain(rays[i], i, "closest_hit and any_hit do not hand back the same");
    if (handed_back[i]) {
      expected_unusual.push_back(static_cast<std::uint32_t>(i));
      if (!same_hit(hit, kUntouched) || is_hit || !is_hit_too)
        complain(rays[i], i, "handed back, but the answer was not left alone");
      if (!same_hit(hits[i], kUntouched) || any[i] || !any[rays.size() + i])
        complain(rays[i], i, "handed back by the batch, but the answer was not left alone");
      continue;
    }
    if (is_hit != hit.is_hit() || is_hit_too != hit.is_hit())
      complain(rays[i], i, "any_hit differs from closest_hit");
    if (!same_bits(hits[i].t, hit.t) || hits[i].is_hit() != hit.is_hit() || hits[i].key != hit.key)
      complain(rays[i], i, "closest_hits differs from closest_hit");
    if (hits[i].is_hit() && tree.key(hits[i].block, hits[i].lane) != hits[i].key)
      complain(rays[i], i, "closest_hits names another triangle's place");
    if (any[i] != hit.is_hit() || any[rays.size() + i] != hit.is_hit())
      complain(rays[i], i, "any_hits differs from any_hit");
  }
  for (std::vector<std::uint32_t>* unusual : {&unusual_closest, &unusual_any}) {
    EXPECT_EQ(unusual->front(), kBefore) << kernels.name;
    unusual->erase(unusual->begin());
    std::sort(unusual->begin(), unusual->end());
    EXPECT_EQ(*unusual, expected_unusual)
        << kernels.name << ": the batch hands back other rays than single calls";
  }
  return handed_back;
}

/// Crossings in one order, of two copies of a triangle that in the first block.
bool comes_first(const TriangleHit& a, const TriangleHit& b) {
  return std::tie(a.t, a.key, a.block, a.lane) < std::tie(b.t, b.key, b.block, b.lane);
}

/// What all_hits_of says of each ray. It appends, and hands back the rays of `handed_back` alone.
std::vector<std::vector<TriangleHit>> all_of_batch(const Kernels& kernels, const TriangleTree& tree,
                                                   std::span<const Ray> rays, const Box3& bounds,
                                                   const std::vector<bool>& handed_back) {
  std::vector<simd::RayCrossing> found = {{kUntouched, 7}};
  std::vector<std::uint32_t> unusual = {123}, expected_unusual = {123};
  kernels.all_hits_of(tree, rays, bounds, found, unusual);
  for (std::uint32_t i = 0; i < rays.size(); ++i)
    if (handed_back[i]) expected_unusual.push_back(i);
  EXPECT_TRUE(unusual.front() == 123 && same_hit(found[0].hit, kUntouched) && found[0].ray_index == 7)
      << kernels.name;
  std::sort(unusual.begin() + 1, unusual.end());
  EXPECT_EQ(unusual, expected_unusual) << kernels.name;

  std::vector<std::vector<TriangleHit>> of_ray(rays.size());
  for (std::size_t k = 1; k < found.size(); ++k) of_ray.at(found[k].ray_index).push_back(found[k].hit);
  for (std::vector<TriangleHit>& hits : of_ray) std::sort(hits.begin(), hits.end(), comes_first);
  return of_ray;
}

Checked expect_equal_to(const Kernels& kernels, const TriangleTree& tree, std::span<const Ray> rays,
                        const Box3& bounds, std::span<const Answer> expected, bool has_copies) {
  Complaints complain{std::string(kernels.name)};
  const std::vector<bool> handed_back = expect_batch_equals_single(kernels, tree, rays, bounds);
  const std::vector<std::vector<TriangleHit>> of_batch =
      all_of_batch(kernels, tree, rays, bounds, handed_back);
  Checked checked{.rays = rays.size()};
  std::vector<TriangleHit> found;
  std::vector<std::pair<float, std::uint32_t>> crossings;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found.assign(1, kUntouched);  // all_hits appends
    if (kernels.all_hits(tree, rays[i], bounds, found) == handed_back[i])
      complain(rays[i], i, "closest_hit and all_hits do not hand back the same");
    if (!same_hit(found.front(), kUntouched)) complain(rays[i], i, "all_hits wrote over what was there");
    if (handed_back[i]) {
      ++checked.handed_back;
      if (found.size() != 1) complain(rays[i], i, "handed back, but all_hits appended something");
      continue;
    }
    std::sort(found.begin() + 1, found.end(), comes_first);
    if (!std::equal(found.begin() + 1, found.end(), of_batch[i].begin(), of_batch[i].end(), same_hit))
      complain(rays[i], i, "all_hits_of differs from all_hits");

    TriangleHit hit;
    kernels.closest_hit(tree, rays[i], bounds, hit);
    if (!equals(hit, expected[i], tree)) complain(rays[i], i, "closest_hit differs from brute force");
    // Each crossing once; and a comparison would not tell -0 from 0.
    crossings.clear();
    for (std::size_t k = 1; k < found.size(); ++k) {
      if (std::signbit(found[k].t)) complain(rays[i], i, "all_hits gives a negative zero");
      if (tree.key(found[k].block, found[k].lane) != found[k].key)
        complain(rays[i], i, "all_hits names another triangle's place");
      crossings.push_back({found[k].t, found[k].key});
    }
    std::sort(crossings.begin(), crossings.end());
    if (has_copies) crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    if (crossings != expected[i].crossings) complain(rays[i], i, "all_hits differs from brute force");
    checked.hits += !expected[i].crossings.empty();
  }
  return checked;
}

Checked expect_kernels_equal_to_brute_force(const std::string& name, const std::vector<Triangle>& triangles,
                                            const std::vector<Ray>& rays,
                                            const std::vector<std::uint32_t>& keys) {
  SCOPED_TRACE(name);
  const std::vector<Answer> expected = brute_answers(triangles, keys, rays);
  Box3 bounds;
  for (const Triangle& triangle : triangles) bounds.extend(triangle.box());
  Checked checked;
  bool is_first = true;
  for (const int width : {4, 8, 16}) {
    const std::vector<PackedTree> trees = every_packed_tree(width, triangles, keys);
    for (const Kernels* kernels : available_kernels()) {
      if (kernels->width != width) continue;
      for (const PackedTree& packed : trees) {
        SCOPED_TRACE(packed.name);
        EXPECT_TRUE(packed.tree->is_ordinary());
        const Checked here = expect_equal_to(*kernels, *packed.tree, rays, bounds, expected);
        if (is_first) checked = here;
        is_first = false;
        EXPECT_EQ(here.handed_back, checked.handed_back) << kernels->name;
        if (::testing::Test::HasFailure()) return checked;
      }
    }
  }
  return checked;
}

}  // namespace boxwood::simd::test
