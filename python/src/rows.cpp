#include "rows.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

#include <nanobind/stl/string.h>

namespace boxwood::python {
namespace {

/// NumPy, imported once and kept for as long as the process lives.
nb::handle numpy() {
  static PyObject* const module = PyImport_ImportModule("numpy");
  if (!module) nb::raise_python_error();
  return module;
}

std::string text(nb::handle value) {
  return nb::cast<std::string>(nb::str(value));
}

}  // namespace

std::size_t count_of(const Shape& shape) {
  // By strides of zero, arrays have more rows than there are bytes; two of them may have more than 2^64.
  constexpr std::size_t kTooMany = std::numeric_limits<std::size_t>::max() / 2;
  if (std::find(shape.begin(), shape.end(), 0) != shape.end()) return 0;
  std::size_t count = 1;
  for (const std::size_t size : shape) count = count > kTooMany / size ? kTooMany : count * size;
  return count;
}

std::string to_string(const Shape& shape, const Shape& row) {
  std::string list;
  for (const Shape& part : {shape, row})
    for (const std::size_t size : part) list += (list.empty() ? "" : ", ") + std::to_string(size);
  return "(" + list + (shape.size() + row.size() == 1 ? ",)" : ")");
}

long long read_integer(const char* name, nb::handle value) {
  nb::object integer;
  if (!PyBool_Check(value.ptr())) integer = nb::steal(PyNumber_Index(value.ptr()));
  if (!integer.is_valid()) {
    PyErr_Clear();
    throw nb::type_error((std::string(name) + ": got " + repr_of(value) + ", expected an integer").c_str());
  }
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
  if (overflow == 0) return number;
  return overflow > 0 ? std::numeric_limits<long long>::max() : std::numeric_limits<long long>::min();
}

std::string repr_of(nb::handle value) {
  return nb::cast<std::string>(nb::repr(value));
}

Rows::Rows(const char* name, nb::handle value, const Shape& row, Accept accept) : name_(name) {
  // A plain number is common and needs no array.
  const bool is_integer = PyLong_Check(value.ptr()) && !PyBool_Check(value.ptr());
  if (row.empty() && accept == Accept::floats_and_integers && (PyFloat_Check(value.ptr()) || is_integer)) {
    scalar_ = is_integer ? PyLong_AsDouble(value.ptr()) : PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred()) {
      PyErr_Clear();
      throw std::invalid_argument(std::string(name) + ": got an integer that is too large for a float");
    }
    data_ = reinterpret_cast<const char*>(&scalar_);
    merge_axes();
    return;
  }
  refuse_masked(value);
  if (!try_buffer(value, accept)) convert(value, accept);
  data_ = static_cast<const char*>(view_.buf);

  // Cut the shape into rows and what is inside of them.
  const std::size_t ndim = static_cast<std::size_t>(view_.ndim);
  bool fits = ndim >= row.size();
  for (std::size_t i = 0; fits && i < row.size(); ++i)
    fits = static_cast<std::size_t>(view_.shape[ndim - row.size() + i]) == row[i];
  if (!fits) {
    std::string expected;
    for (const std::size_t size : row) expected += ", " + std::to_string(size);
    const std::string got = to_string(Shape(view_.shape, view_.shape + ndim));
    PyBuffer_Release(&view_);
    throw std::invalid_argument(std::string(name) + ": got an array of shape " + got +
                                ", expected shape (..." + expected + ")");
  }
  // Some, such as ctypes, leave out the strides of what lies without gaps.
  strides_ = view_.strides;
  if (!strides_) {
    own_strides_.resize(ndim);
    Py_ssize_t stride = view_.itemsize;
    for (std::size_t i = ndim; i-- > 0; stride *= view_.shape[i]) own_strides_[i] = stride;
    strides_ = own_strides_.data();
  }
  for (std::size_t i = 0; i < ndim; ++i) {
    const Axis axis{static_cast<std::size_t>(view_.shape[i]), strides_[i]};
    if (i < ndim - row.size()) {
      shape_.push_back(axis.size);
      leading_.push_back(axis);
    } else {
      row_.push_back(axis);
    }
  }
  merge_axes();
}

Rows::~Rows() {
  if (has_view_) PyBuffer_Release(&view_);
}

void Rows::refuse_masked(nb::handle value) const {
  // NumPy's masked arrays show their numbers to whoever asks, and only they know which of them do not count.
  static const nb::handle plain = nb::object(numpy().attr("ndarray")).release();
  if (value.type().is(plain) ||
      !PyObject_TypeCheck(value.ptr(), reinterpret_cast<PyTypeObject*>(plain.ptr())))
    return;
  const nb::object mask = nb::getattr(value, "mask", nb::none());
  if (!mask.is_none() && nb::cast<bool>(nb::bool_(numpy().attr("any")(mask))))
    throw nb::type_error((std::string(name_) +
                          ": got an array with masked numbers, expected plain ones, such as .filled() gives")
                             .c_str());
}

bool Rows::try_buffer(nb::handle value, Accept accept) {
  if (!PyObject_CheckBuffer(value.ptr()) || PyBytes_Check(value.ptr())) return false;
  if (PyObject_GetBuffer(value.ptr(), &view_, PyBUF_STRIDES | PyBUF_FORMAT) != 0) {
    PyErr_Clear();
    return false;
  }

  // One letter says the type; what stands before it may say that the bytes are in this machine's order.
  constexpr char kOwnOrder = std::endian::native == std::endian::little ? '<' : '>';
  const char* format = view_.format ? view_.format : "B";
  if (*format == '@' || *format == '=' || *format == kOwnOrder) ++format;
  std::optional<Number> number;
  if (format[0] != 0 && format[1] == 0) {
    const Py_ssize_t size = view_.itemsize;
    if (format[0] == 'f' && size == 4) number = Number::f32;
    if (format[0] == 'd' && size == 8) number = Number::f64;
    const Number signed_of_size[] = {Number::i8, Number::i16, Number::i32, Number::i64};
    const Number unsigned_of_size[] = {Number::u8, Number::u16, Number::u32, Number::u64};
    const int log_size = size == 1 ? 0 : size == 2 ? 1 : size == 4 ? 2 : 3;
    if (std::strchr("bhilq", format[0])) number = signed_of_size[log_size];
    if (std::strchr("BHILQ", format[0])) number = unsigned_of_size[log_size];
  }
  if (!number || (accept == Accept::integers && (*number == Number::f32 || *number == Number::f64))) {
    PyBuffer_Release(&view_);
    return false;
  }
  number_ = *number;
  has_view_ = true;
  return true;
}

void Rows::convert(nb::handle value, Accept accept) {
  nb::object array;
  try {
    array = numpy().attr("asarray")(value);
  } catch (nb::python_error& error) {
    // Ctrl-C and a lack of memory are no fault of the argument.
    if (!error.matches(PyExc_Exception) || error.matches(PyExc_MemoryError)) throw;
    const bool is_value = error.matches(PyExc_ValueError);
    nb::raise_from(error, is_value ? PyExc_ValueError : PyExc_TypeError, "%s: not an array: %s", name_,
                   text(error.value()).c_str());
  }
  const std::string kind = text(array.attr("dtype").attr("kind"));
  const bool is_integer = kind == "i" || kind == "u";
  // An empty list is an array of floats to NumPy, and holds no wrong number.
  const bool is_empty = nb::cast<std::size_t>(array.attr("size")) == 0 && kind == "f";
  if (!is_integer && (kind != "f" || (accept == Accept::integers && !is_empty)))
    throw nb::type_error((std::string(name_) + ": got numbers of type " + text(array.attr("dtype")) +
                          ", expected " + (accept == Accept::integers ? "integers" : "floats or integers"))
                             .c_str());
  const char* type =
      is_integer || accept == Accept::integers ? (kind == "u" ? "uint64" : "int64") : "float64";
  array = array.attr("astype")(type);
  if (!try_buffer(array, accept))
    throw nb::type_error((std::string(name_) + ": cannot be read as an array of numbers").c_str());
}

void Rows::broadcast_to(const Shape& shape) {
  if (shape == shape_) return;
  // Begin again from the array's own axes: the last of them meet the last of `shape`.
  std::vector<Axis> axes(shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    axes[i] = {shape[i], 0};
    const std::size_t missing = shape.size() - shape_.size();
    if (i >= missing && shape_[i - missing] != 1) axes[i].stride = strides_[i - missing];
  }
  shape_ = shape;
  leading_ = std::move(axes);
  merge_axes();
}

void Rows::merge_axes() {
  // Two axes that one stride runs through are one; axes of size 1 are none.
  std::vector<Axis> merged;
  for (const Axis& axis : leading_) {
    if (axis.size == 1) continue;
    if (!merged.empty() && merged.back().stride == axis.stride * static_cast<std::ptrdiff_t>(axis.size))
      merged.back() = {merged.back().size * axis.size, axis.stride};
    else
      merged.push_back(axis);
  }
  if (merged.empty()) merged.push_back({1, 0});
  leading_ = std::move(merged);
}

const char* Rows::packed_triples() const {
  const bool are_floats =
      number_ == Number::f32 && row_.size() == 1 && row_[0].size == 3 && row_[0].stride == sizeof(float);
  return are_floats && leading_.size() == 1 && leading_[0].stride == 3 * sizeof(float) ? data_ : nullptr;
}

std::optional<float> Rows::constant() const {
  if (!row_.empty() || leading_.size() != 1 || leading_[0].stride != 0) return std::nullopt;
  float number = 0;
  read(0, 1, &number, 1);
  return number;
}

template <class T, class Out>
void Rows::read_as(std::size_t begin, std::size_t count, Out* out, std::size_t stride) const {
  const auto load = [](const char* from) {
    T number;
    std::memcpy(&number, from, sizeof number);  // strided numbers may stand at any address
    return static_cast<Out>(number);
  };
  while (count > 0) {
    // Find where row `begin` stands, and how many follow it at the same stride.
    const Axis& last = leading_.back();
    const std::size_t run = std::min(count, last.size - begin % last.size);
    const char* from = data_;
    for (std::size_t rest = begin, i = leading_.size(); i-- > 0; rest /= leading_[i].size)
      from += static_cast<std::ptrdiff_t>(rest % leading_[i].size) * leading_[i].stride;

    if (row_.empty() && last.stride == 0) {
      const Out number = load(from);
      for (std::size_t i = 0; i < run; ++i) out[i * stride] = number;
    } else if (row_.empty()) {
      for (std::size_t i = 0; i < run; ++i, from += last.stride) out[i * stride] = load(from);
    } else if (row_.size() == 1 && row_[0].size == 3 && row_[0].stride == sizeof(T)) {
      for (std::size_t i = 0; i < run; ++i, from += last.stride) {
        out[i * stride] = load(from);
        out[i * stride + 1] = load(from + sizeof(T));
        out[i * stride + 2] = load(from + 2 * sizeof(T));
      }
    } else if (row_.size() == 1 && row_[0].size == 3) {
      const std::ptrdiff_t step = row_[0].stride;
      for (std::size_t i = 0; i < run; ++i, from += last.stride)
        for (std::ptrdiff_t k = 0; k < 3; ++k) out[i * stride + k] = load(from + k * step);
    } else {
      for (std::size_t i = 0; i < run; ++i, from += last.stride) {
        Out* to = out + i * stride;
        const Axis outer = row_.size() == 2 ? row_[0] : Axis{1, 0};
        for (std::size_t j = 0; j < outer.size; ++j)
          for (std::size_t k = 0; k < row_.back().size; ++k)
            *to++ = load(from + static_cast<std::ptrdiff_t>(j) * outer.stride +
                         static_cast<std::ptrdiff_t>(k) * row_.back().stride);
      }
    }
    begin += run;
    count -= run;
    out += run * stride;
  }
}

template <class Out>
void Rows::read_any(std::size_t begin, std::size_t count, Out* out, std::size_t stride) const {
  switch (number_) {
    case Number::f32:
      return read_as<float>(begin, count, out, stride);
    case Number::f64:
      return read_as<double>(begin, count, out, stride);
    case Number::i8:
      return read_as<std::int8_t>(begin, count, out, stride);
    case Number::i16:
      return read_as<std::int16_t>(begin, count, out, stride);
    case Number::i32:
      return read_as<std::int32_t>(begin, count, out, stride);
    case Number::i64:
      return read_as<std::int64_t>(begin, count, out, stride);
    case Number::u8:
      return read_as<std::uint8_t>(begin, count, out, stride);
    case Number::u16:
      return read_as<std::uint16_t>(begin, count, out, stride);
    case Number::u32:
      return read_as<std::uint32_t>(begin, count, out, stride);
    case Number::u64:
      return read_as<std::uint64_t>(begin, count, out, stride);
  }
}

void Rows::read(std::size_t begin, std::size_t count, float* out, std::size_t stride) const {
  read_any(begin, count, out, stride);
}
void Rows::read(std::size_t begin, std::size_t count, std::int64_t* out, std::size_t stride) const {
  read_any(begin, count, out, stride);
}

Shape broadcast_shapes(std::initializer_list<const Rows*> arrays) {
  Shape all;
  std::vector<const Rows*> from;  // who gave each dimension
  for (const Rows* array : arrays) {
    const Shape& shape = array->shape();
    if (shape.size() > all.size()) {
      all.insert(all.begin(), shape.size() - all.size(), 1);
      from.insert(from.begin(), all.size() - from.size(), array);
    }
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const std::size_t j = all.size() - shape.size() + i;
      if (shape[i] == all[j] || shape[i] == 1) continue;
      if (all[j] != 1)
        throw std::invalid_argument(std::string(array->name()) + ": leading shape " + to_string(shape) +
                                    " does not fit " + to_string(from[j]->shape()) + " of " +
                                    from[j]->name() + ", expected the same, or 1 where they differ");
      all[j] = shape[i];
      from[j] = array;
    }
  }
  return all;
}

}  // namespace boxwood::python
