// rows.h: how are numbers read from whatever array came?
//
// In place: an array of any float or integer type and any strides is read where it lies, chunk by chunk, and
// converted to float on the way into a chunk of rays. Only what the machine has no type for (half floats, the
// other byte order, lists) is converted by NumPy first. Nothing is ever written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

namespace boxwood::python {

namespace nb = nanobind;

/// The leading dimensions of arrays: (480, 640) for one of shape (480, 640, 3); empty for a single row.
using Shape = std::vector<std::size_t>;

/// How many rows that is; more than memory holds when it is more than a number holds.
std::size_t count_of(const Shape& shape);
/// "(480, 640, 3)", with `row` behind the leading dimensions.
std::string to_string(const Shape& shape, const Shape& row = {});

/// The whole number that an argument is; the nearest of 64 bits when it has more. Throws TypeError.
long long read_integer(const char* name, nb::handle value);

/// As Python writes it: for messages.
std::string repr_of(nb::handle value);

/// An array whose last `row` dimensions make one row, and whose others count rows.
class Rows {
 public:
  enum class Accept { floats_and_integers, integers };

  /// `name` is the argument's, for messages. Throws ValueError for a shape that does not end like `row`,
  /// TypeError for anything but numbers of the accepted kind.
  Rows(const char* name, nb::handle value, const Shape& row, Accept accept = Accept::floats_and_integers);
  ~Rows();
  Rows(const Rows&) = delete;

  const char* name() const { return name_; }
  /// Numbers of 64 bits without a sign, which read() gives as negative ones where they are too large.
  bool is_u64() const { return number_ == Number::u64; }
  const Shape& shape() const { return shape_; }
  std::size_t count() const { return count_of(shape_); }

  /// Repeats rows as NumPy's broadcasting does, so that shape() becomes `shape`. Precondition: it fits
  /// (broadcast_shapes).
  void broadcast_to(const Shape& shape);

  /// Where rows of three stand one behind the other as they are, in float32; null when they do not.
  const char* packed_triples() const;
  /// The number that every row is, when it is one number. Precondition: there is a row.
  std::optional<float> constant() const;

  /// Writes the numbers of rows [begin, begin + count), row i to out + i * stride. Any thread may call, with
  /// or without the GIL.
  void read(std::size_t begin, std::size_t count, float* out, std::size_t stride) const;
  void read(std::size_t begin, std::size_t count, std::int64_t* out, std::size_t stride) const;

 private:
  enum class Number { f32, f64, i8, i16, i32, i64, u8, u16, u32, u64 };
  struct Axis {
    std::size_t size;
    std::ptrdiff_t stride;  // bytes
  };

  void refuse_masked(nb::handle value) const;
  bool try_buffer(nb::handle value, Accept accept);
  void convert(nb::handle value, Accept accept);
  template <class T, class Out>
  void read_as(std::size_t begin, std::size_t count, Out* out, std::size_t stride) const;
  template <class Out>
  void read_any(std::size_t begin, std::size_t count, Out* out, std::size_t stride) const;
  void merge_axes();

  const char* name_;
  Py_buffer view_{};
  bool has_view_ = false;
  double scalar_ = 0;  // of a plain Python number
  const char* data_ = nullptr;
  Number number_ = Number::f64;
  const Py_ssize_t* strides_ = nullptr;  // of all dimensions
  std::vector<Py_ssize_t> own_strides_;  // where the view has none
  Shape shape_;                          // leading
  std::vector<Axis> leading_;            // of shape_, then merged
  std::vector<Axis> row_;                // inside a row
};

/// What all of them broadcast to. Throws ValueError that names two which do not fit.
Shape broadcast_shapes(std::initializer_list<const Rows*> arrays);

}  // namespace boxwood::python
