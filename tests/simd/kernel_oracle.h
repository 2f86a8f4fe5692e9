// kernel_oracle.h: does every kernel give the answer of brute force, on every tree?
//
// One call checks one set of triangles: brute force answers the rays once, then each set of kernels that this
// machine can run answers them on wide trees from every builder, one by one and as a batch. Answers must be
// equal to the bit. A ray that a kernel hands back must be handed back by every call, with the answer left
// alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "boxwood/core/ray.h"
#include "boxwood/simd/kernels.h"
#include "support/every_tree.h"

namespace boxwood::simd::test {

inline constexpr Layout kLayouts[] = {Layout::full, Layout::compact};

/// The tree of `width` children a node. One in the compact layout needs the triangles as long as it lives.
std::unique_ptr<TriangleTree> pack(int width, const Bvh& bvh, std::span<const Triangle> triangles,
                                   std::span<const std::uint32_t> keys = {}, Layout layout = Layout::full);

/// What brute force says of one ray: t and key of each crossing, in the order of the contract, each once.
struct Answer {
  std::vector<std::pair<float, std::uint32_t>> crossings;
};

/// The answers of brute force. `keys` may be empty: then a triangle's key is its number.
std::vector<Answer> brute_answers(std::span<const Triangle> triangles, std::span<const std::uint32_t> keys,
                                  std::span<const Ray> rays);

/// Whether two floats are the same bits.
bool same_bits(float a, float b);

/// A batch and single calls must say the same; returns which rays were handed back.
std::vector<bool> expect_batch_equals_single(const Kernels& kernels, const TriangleTree& tree,
                                             std::span<const Ray> rays, const Box3& bounds);

/// What was checked, so that a test can see that it was not too easy.
struct Checked {
  std::size_t rays = 0, hits = 0, handed_back = 0;
};

/// Compares every answer of `kernels` on `tree` with `expected`. `has_copies`: a triangle may stand in
/// several blocks, so all_hits may name it again.
Checked expect_equal_to(const Kernels& kernels, const TriangleTree& tree, std::span<const Ray> rays,
                        const Box3& bounds, std::span<const Answer> expected, bool has_copies = false);

/// The same for every set of kernels on the trees of every builder; and every set must hand back the same
/// rays. Counts one set on one tree.
Checked expect_kernels_equal_to_brute_force(const std::string& name, const std::vector<Triangle>& triangles,
                                            const std::vector<Ray>& rays,
                                            const std::vector<std::uint32_t>& keys = {});

}  // namespace boxwood::simd::test
