// layout-inl.h: how does a kernel read a node and a block? Compiled once for each instruction set
// (kernels.cpp).
//
// Kernels are written once for both layouts of triangle_tree.h. A node shows its planes as vectors, and where
// its children lead; a block is a TriangleBlock, in place or put together.

#if defined(BOXWOOD_SIMD_LAYOUT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_LAYOUT_INL_H
#undef BOXWOOD_SIMD_LAYOUT_INL_H
#else
#define BOXWOOD_SIMD_LAYOUT_INL_H
#endif

#include <cstddef>

#include "boxwood/simd/lanes-inl.h"
#include "boxwood/simd/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

using DW = hn::FixedTag<float, kWidth>;
using DIW = hn::FixedTag<std::int32_t, kWidth>;
using VW = hn::Vec<DW>;
using VIW = hn::Vec<DIW>;

inline constexpr int kLine = 64;

/// Prefetches `kLines` lines.
template <int kLines>
HWY_INLINE void prefetch_lines(const char* p) {
  for (int line = 0; line < kLines; ++line) __builtin_prefetch(p + kLine * line);
}

struct FullLayout {
  using Node = WideNode<kWidth>;
  static constexpr int kNodeLines = sizeof(Node) / kLine;
  static constexpr std::size_t kBlockBytes = sizeof(TriangleBlock);

  /// The planes of an axis, at the byte `row` of a node in full.
  class Planes {
   public:
    HWY_INLINE explicit Planes(const char* node) : node_(node) {}
    HWY_INLINE VW row(int, std::ptrdiff_t row) const {
      return hn::Load(DW(), reinterpret_cast<const float*>(node_ + row));
    }
    HWY_INLINE float plane(int, std::ptrdiff_t row, std::uint32_t child) const {
      return reinterpret_cast<const float*>(node_ + row)[child];
    }

   private:
    const char* node_;
  };

  static HWY_INLINE const TriangleBlock& block(const char* p) {
    return *reinterpret_cast<const TriangleBlock*>(p);
  }
};

struct CompactLayout {
  using Node = QuantizedNode<kWidth>;
  static constexpr int kNodeLines = sizeof(Node) / kLine;
  static constexpr std::size_t kBlockBytes = sizeof(CompactBlock);

  /// The same, from the bytes of a quantized node: fused or not, the sum is the one of Node::box().
  class Planes {
   public:
    HWY_INLINE explicit Planes(const char* node) : node_(*reinterpret_cast<const Node*>(node)) {}
    HWY_INLINE VW row(int k, std::ptrdiff_t row) const {
      const DW d;
      const DIW di;
      const hn::Rebind<std::uint8_t, DIW> du8;
      const VIW steps = hn::PromoteTo(di, hn::LoadU(du8, bytes(row)));
      return hn::MulAdd(hn::ConvertTo(d, steps), hn::Set(d, node_.step[k]), hn::Set(d, node_.origin[k]));
    }
    HWY_INLINE float plane(int k, std::ptrdiff_t row, std::uint32_t child) const {
      return static_cast<float>(bytes(row)[child]) * node_.step[k] + node_.origin[k];
    }

   private:
    /// A plane takes one byte here and four in a node in full.
    HWY_INLINE const std::uint8_t* bytes(std::ptrdiff_t row) const { return node_.planes[0][0] + row / 4; }
    const Node& node_;
  };

  /// Fetches the corners, so that a vector is the same coordinate of all four triangles.
  static HWY_INLINE TriangleBlock block(const char* p) {
    const D4 d;
    const DI4 di;
    const auto& from = *reinterpret_cast<const CompactBlock*>(p);
    TriangleBlock block;
    for (int corner = 0; corner < 3; ++corner) {
      V4 v[kBlockWidth];
      for (int lane = 0; lane < kBlockWidth; ++lane) {
        const Vec3& at = from.vertices[lane][from.index[corner][lane]];
        v[lane] = hn::ConcatLowerLower(d, hn::Set(d, at.z), first_two(&at.x));
      }
      // Four rows of x, y, z become three columns.
      const V4 xy01 = hn::InterleaveLower(d, v[0], v[1]), xy23 = hn::InterleaveLower(d, v[2], v[3]);
      const V4 z01 = hn::InterleaveUpper(d, v[0], v[1]), z23 = hn::InterleaveUpper(d, v[2], v[3]);
      hn::Store(hn::ConcatLowerLower(d, xy23, xy01), d, block.v[corner][0]);
      hn::Store(hn::ConcatUpperUpper(d, xy23, xy01), d, block.v[corner][1]);
      hn::Store(hn::ConcatLowerLower(d, z23, z01), d, block.v[corner][2]);
    }
    hn::Store(hn::Load(di, reinterpret_cast<const std::int32_t*>(from.key)), di,
              reinterpret_cast<std::int32_t*>(block.key));
    return block;
  }

 private:
  /// Two floats in the lower half.
  static HWY_INLINE V4 first_two(const float* p) {
    return hn::ZeroExtendVector(D4(), hn::LoadU(hn::FixedTag<float, 2>(), p));
  }
};

HWY_INLINE const char* node_at(const char* pool, std::uint32_t ref) {
  return pool + std::size_t(ref) * 2;
}
template <class Layout>
HWY_INLINE const std::int32_t* children_of(const char* node) {
  return reinterpret_cast<const std::int32_t*>(node + offsetof(typename Layout::Node, children));
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
