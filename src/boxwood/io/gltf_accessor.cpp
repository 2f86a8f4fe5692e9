#include "boxwood/io/gltf_accessor.h"

#include <cmath>
#include <cstring>

#include <tiny_gltf.h>

namespace boxwood::io::gltf {
namespace {

/// Elements in memory, `stride` bytes apart; all of them are known to be there.
struct Elements {
  const std::byte* data;
  std::size_t stride;
};

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;  // not among those that the format allows
  }
}

template <class T>
T load(const std::byte* at) {  // elements need not be aligned
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Finds `count` elements of `size` bytes that begin `offset` bytes into a view:
/// one behind the other, or apart as the view says.
Elements locate(const File& file, int view, std::size_t offset, std::size_t count, std::size_t size,
                bool use_view_stride, const std::string& where) {
  const std::span<const std::byte> bytes = view_bytes(file, view, where);
  std::size_t stride = use_view_stride ? file.model->bufferViews[view].byteStride : 0;
  if (stride == 0) stride = size;
  if (stride < size)
    file.fail(where, "buffer view " + std::to_string(view) + " has a stride of " + std::to_string(stride) +
                         " bytes, expected at least the " + std::to_string(size) + " of an element");

  // In this order nothing overflows.
  const bool fits = offset <= bytes.size() && bytes.size() - offset >= size &&
                    (count - 1) <= (bytes.size() - offset - size) / stride;
  if (!fits)
    file.fail(where, std::to_string(count) + " elements of " + std::to_string(size) + " bytes, " +
                         std::to_string(stride) + " apart, from byte " + std::to_string(offset) +
                         " do not fit into the " + std::to_string(bytes.size()) + " bytes of buffer view " +
                         std::to_string(view));
  return {bytes.data() + offset, stride};
}

const tinygltf::Accessor& find_accessor(const File& file, int index, const std::string& where) {
  const auto& accessors = file.model->accessors;
  if (index < 0 || std::size_t(index) >= accessors.size())
    file.fail(where, "accessor " + std::to_string(index) + " does not exist, there are " +
                         std::to_string(accessors.size()));
  return accessors[index];
}

float component(const std::byte* at, int type, bool is_normalized) {
  // Fractions as the specification gives them, section 3.11 ("Animations") and KHR_mesh_quantization.
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<std::int8_t>(at);
      return is_normalized ? max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = load<std::uint8_t>(at);
      return is_normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<std::int16_t>(at);
      return is_normalized ? max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<std::uint16_t>(at);
      return is_normalized ? value / 65535.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
      const auto value = load<std::uint32_t>(at);
      return static_cast<float>(is_normalized ? value / 4294967295.0 : double(value));
    }
    default:
      return load<float>(at);
  }
}

std::uint32_t unsigned_component(const std::byte* at, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

bool is_unsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Calls `take(element, bytes)` for each element of an accessor,
/// and again for those that its sparse part replaces.
template <class Take>
void for_each_element(const File& file, const tinygltf::Accessor& accessor, std::size_t size,
                      const std::string& where, const Take& take) {
  if (accessor.bufferView >= 0) {
    const Elements elements =
        locate(file, accessor.bufferView, accessor.byteOffset, accessor.count, size, true, where);
    for (std::size_t i = 0; i < accessor.count; ++i) take(i, elements.data + i * elements.stride);
  }
  if (!accessor.sparse.isSparse) return;

  const auto& sparse = accessor.sparse;
  const std::string place = where + ", sparse";
  if (sparse.count < 1 || std::size_t(sparse.count) > accessor.count)
    file.fail(place, "the count is " + std::to_string(sparse.count) + ", expected 1 to the " +
                         std::to_string(accessor.count) + " elements");
  if (!is_unsigned(sparse.indices.componentType))
    file.fail(place, "the indices are of component type " + std::to_string(sparse.indices.componentType) +
                         ", expected unsigned integers");
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    file.fail(place, "a byte offset is negative");
  const Elements indices = locate(file, sparse.indices.bufferView, sparse.indices.byteOffset, sparse.count,
                                  component_size(sparse.indices.componentType), false, place + " indices");
  const Elements values = locate(file, sparse.values.bufferView, sparse.values.byteOffset, sparse.count, size,
                                 false, place + " values");
  for (int i = 0; i < sparse.count; ++i) {
    const std::uint32_t index =
        unsigned_component(indices.data + i * indices.stride, sparse.indices.componentType);
    if (index >= accessor.count)
      file.fail(place, "index " + std::to_string(i) + " is " + std::to_string(index) + ", but there are " +
                           std::to_string(accessor.count) + " elements");
    take(index, values.data + i * values.stride);
  }
}

void check_count(const File& file, const tinygltf::Accessor& accessor, std::size_t element_size,
                 const std::string& where) {
  if (accessor.count == 0) file.fail(where, "the accessor has no elements");
  // Without a view all elements are 0, so that nothing but this bounds how many a few bytes can ask for.
  constexpr std::size_t kMostBytes = std::size_t(1) << 30;
  if (accessor.bufferView < 0 && accessor.count > kMostBytes / element_size)
    file.fail(where, "the accessor has " + std::to_string(accessor.count) + " elements and no buffer view");
  // The view is looked at before memory is taken for what it is said to hold.
  if (accessor.bufferView >= 0)
    (void)locate(file, accessor.bufferView, accessor.byteOffset, accessor.count, element_size, true, where);
}

void set(Vec2& out, const float* n) {
  out = {n[0], n[1]};
}
void set(Vec3& out, const float* n) {
  out = {n[0], n[1], n[2]};
}
void set(std::array<float, 4>& out, const float* n) {
  out = {n[0], n[1], n[2], n[3]};
}
void set(Affine3& out, const float* n) {  // column by column
  out = {{n[0], n[1], n[2]}, {n[4], n[5], n[6]}, {n[8], n[9], n[10]}, {n[12], n[13], n[14]}};
}

/// Vectors of 2, 3 or 4 components, what is left of a `Vector` is 0, 0, 0, 1; or matrices of 16.
template <class Vector, std::size_t components>
std::vector<Vector> read_vectors(const File& file, int index, const std::string& asked_by) {
  const std::string where = asked_by + ", accessor " + std::to_string(index);
  const tinygltf::Accessor& accessor = find_accessor(file, index, where);
  constexpr std::array kTypes{TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
  constexpr int kType = components == 16 ? TINYGLTF_TYPE_MAT4 : kTypes[components <= 4 ? components - 2 : 0];
  const std::size_t size = component_size(accessor.componentType);
  if (accessor.type != kType || size == 0)
    file.fail(where, "the accessor is of type " + std::to_string(accessor.type) + " with component type " +
                         std::to_string(accessor.componentType) + ", expected " +
                         (components == 16 ? "MAT4" : "VEC" + std::to_string(components)) + " of numbers");
  check_count(file, accessor, size * components, where);

  std::vector<Vector> out(accessor.count);
  for_each_element(file, accessor, size * components, where, [&](std::size_t i, const std::byte* at) {
    std::array<float, 16> values{0, 0, 0, 1};
    for (std::size_t c = 0; c < components; ++c) {
      values[c] = component(at + c * size, accessor.componentType, accessor.normalized);
      if (!std::isfinite(values[c]))
        file.fail(where, "element " + std::to_string(i) + ", number " + std::to_string(c) + " is " +
                             std::to_string(values[c]) + ", expected a finite number");
    }
    set(out[i], values.data());
  });
  return out;
}

}  // namespace

std::span<const std::byte> view_bytes(const File& file, int index, const std::string& where) {
  const auto& views = file.model->bufferViews;
  if (index < 0 || std::size_t(index) >= views.size())
    file.fail(where, "buffer view " + std::to_string(index) + " does not exist, there are " +
                         std::to_string(views.size()));
  const tinygltf::BufferView& view = views[index];
  const auto& buffers = file.model->buffers;
  if (view.buffer < 0 || std::size_t(view.buffer) >= buffers.size())
    file.fail(where, "buffer view " + std::to_string(index) + " is of buffer " + std::to_string(view.buffer) +
                         ", but there are " + std::to_string(buffers.size()));
  const std::vector<unsigned char>& data = buffers[view.buffer].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    file.fail(where, "buffer view " + std::to_string(index) + " takes " + std::to_string(view.byteLength) +
                         " bytes from byte " + std::to_string(view.byteOffset) + ", but buffer " +
                         std::to_string(view.buffer) + " has " + std::to_string(data.size()));
  return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

std::vector<Vec2> read_vec2(const File& file, int accessor, const std::string& where) {
  return read_vectors<Vec2, 2>(file, accessor, where);
}

std::vector<Vec3> read_vec3(const File& file, int accessor, const std::string& where) {
  return read_vectors<Vec3, 3>(file, accessor, where);
}

std::vector<std::array<float, 4>> read_vec4(const File& file, int accessor, const std::string& where) {
  return read_vectors<std::array<float, 4>, 4>(file, accessor, where);
}

std::vector<Affine3> read_affine(const File& file, int accessor, const std::string& where) {
  return read_vectors<Affine3, 16>(file, accessor, where);
}

std::vector<std::array<float, 4>> read_colors(const File& file, int accessor, const std::string& where) {
  using Color = std::array<float, 4>;
  const bool has_alpha = find_accessor(file, accessor, where).type == TINYGLTF_TYPE_VEC4;
  return has_alpha ? read_vectors<Color, 4>(file, accessor, where)
                   : read_vectors<Color, 3>(file, accessor, where);
}

std::vector<std::uint32_t> read_indices(const File& file, int index, const std::string& asked_by) {
  const std::string where = asked_by + ", accessor " + std::to_string(index);
  const tinygltf::Accessor& accessor = find_accessor(file, index, where);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned(accessor.componentType))
    file.fail(where, "the accessor is of type " + std::to_string(accessor.type) + " with component type " +
                         std::to_string(accessor.componentType) + ", expected scalar unsigned integers");
  const std::size_t size = component_size(accessor.componentType);
  check_count(file, accessor, size, where);
  std::vector<std::uint32_t> out(accessor.count);
  for_each_element(file, accessor, size, where, [&](std::size_t i, const std::byte* at) {
    out[i] = unsigned_component(at, accessor.componentType);
  });
  return out;
}

}  // namespace boxwood::io::gltf
