// answers.h: where do the answers stand that Python sees as NumPy arrays?
//
// Each result owns one block of memory with a column for each field, written once, by the threads that work
// the answers out. An array over a column is made when somebody asks for it, and shares the block: nothing is
// copied, and a result of one ray costs no seven arrays.
#pragma once

#include <limits>
#include <memory>
#include <new>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "boxwood/core/memory_block.h"
#include "boxwood/scene/scene.h"
#include "boxwood/scene/surface.h"
#include "rows.h"

namespace boxwood::python {

/// Memory that results and their arrays share.
using Block = std::shared_ptr<MemoryBlock>;

/// Becomes Python's MemoryError, with these words.
class NoRoomForResults final : public std::bad_alloc {
 public:
  const char* what() const noexcept override { return "the results need more memory than there is"; }
};

/// A block of so many bytes, perhaps one that an earlier result has left: clearing fresh pages costs a tenth
/// of the time in which a million rays are answered, and more where the system is short of them. One block of
/// at most kMaxSpareBytes is kept for that, where the system can take its pages back while nobody uses them.
#if defined(__linux__)
constexpr std::size_t kMaxSpareBytes = std::size_t(1) << 30;
#else
constexpr std::size_t kMaxSpareBytes = std::size_t(64) << 20;
#endif
/// Throws NoRoomForResults.
Block allocate_block(std::size_t size);

/// Lays columns one behind the other, each on a cache line of its own.
class Layout {
 public:
  /// Throws NoRoomForResults when the size is more than a number holds.
  template <class T>
  std::size_t add(std::size_t count) {
    constexpr std::size_t kLine = 64;
    if (count > (std::numeric_limits<std::size_t>::max() - size_ - kLine) / sizeof(T))
      throw NoRoomForResults();
    const std::size_t at = size_;
    size_ = (size_ + count * sizeof(T) + kLine - 1) / kLine * kLine;
    return at;
  }
  Block allocate() const { return allocate_block(size_); }

 private:
  std::size_t size_ = 0;
};

/// Throws ValueError when NumPy has no arrays of so many dimensions.
void expect_dimensions(nb::handle array, std::size_t count);

/// An array over `data` that keeps `block` alive; rows of `width` numbers, or single numbers for width 0.
template <class T>
nb::object make_array(const Block& block, T* data, const Shape& leading, std::size_t width = 0) {
  Shape shape = leading;
  if (width > 0) shape.push_back(width);
  nb::capsule owner(new Block(block), [](void* p) noexcept { delete static_cast<Block*>(p); });
  nb::object array = nb::cast(nb::ndarray<nb::numpy, T>(data, shape.size(), shape.data(), owner));
  expect_dimensions(array, shape.size());
  return array;
}

/// One field of a result: where it stands in the block, and the array once somebody has asked.
template <class T>
struct Column {
  T* data = nullptr;
  std::size_t width = 0;
  nb::object array;

  nb::object get(const Block& block, const Shape& shape) {
    if (!array.is_valid()) array = make_array(block, data, shape, width);
    return array;
  }
};

/// Which primitive of what: -1 for none.
struct Ids {
  Column<std::int32_t> primitive_id, geometry_id, instance_id;
};

/// The columns of hits, and how one is written.
struct HitColumns {
  Column<float> t, uv, normal, position;
  Ids ids;
  Column<std::int32_t> part;
  bool is_large = false;  ///< Too large for a cache.

  HitColumns() = default;
  /// Room for `count` hits.
  HitColumns(std::size_t count, Block& block);
  /// Writes hits[i], which answers rays[i], as row begin + i.
  void write(std::size_t begin, std::span<const Ray> rays, std::span<const Hit> hits);
  /// Row `i`, each number read once.
  Hit read(std::size_t i) const;
};

/// Closest hits: one row for each ray.
struct Hits {
  Shape shape;
  Block block;
  HitColumns columns;

  explicit Hits(const Shape& leading) : shape(leading), columns(count_of(leading), block) {}
};

/// All hits: row offsets[i] to offsets[i + 1] for ray i.
struct AllHits {
  Shape shape;
  std::size_t count = 0;  // of hits
  Block offset_block, block;
  Column<std::int64_t> offsets;
  HitColumns columns;

  /// Room for the offsets; and for the hits, once their number is known.
  explicit AllHits(const Shape& shape);
  void make_room(std::size_t hits);
};

/// Nearest points: one row for each point.
struct Points {
  Shape shape;
  Block block;
  Column<float> distance, position;
  Ids ids;

  explicit Points(const Shape& shape);
  void write(std::size_t begin, std::span<const ScenePoint> points);
};

/// Places of hits: one row for each ray.
struct Surfaces {
  Shape shape;
  Block block;
  Column<float> position, error, normal, shading_normal, uv;

  explicit Surfaces(const Shape& shape);
  /// Row `i`; without a surface, NaN.
  void write(std::size_t i, const Surface* surface);
  Surface read(std::size_t i) const;
};

void bind_answers(nb::module_& module);

}  // namespace boxwood::python
