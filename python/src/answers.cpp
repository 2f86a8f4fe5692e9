#include "answers.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <limits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <nanobind/stl/string.h>

#include "boxwood/core/lanes.h"
#include "docstrings.h"
#include "past_cache.h"
#include "pickles.h"
#include "running.h"

namespace boxwood::python {
namespace {

/// Results above this do not stay in a cache until somebody looks at them.
constexpr std::size_t kMinLargeBytes = std::size_t(4) << 20;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void put(float* to, Vec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

Vec3 vec(const float* from) {
  return {from[0], from[1], from[2]};
}

/// None is all bits set, which is -1.
std::int32_t signed_id(std::uint32_t value) {
  return static_cast<std::int32_t>(value);
}

/// The bytes of a hit or a ray from one of its fields on.
template <class T>
const char* part_of(const T& whole, std::size_t offset) {
  return reinterpret_cast<const char*>(&whole) + offset;
}

template <class T>
Column<T> column(const Block& block, std::size_t offset, std::size_t width = 0) {
  return {reinterpret_cast<T*>(block->data() + offset), width, {}};
}

/// Describes a result in a line: "<boxwood.Hits: shape (480, 640), 1234 of 307200 hit>".
std::string describe(const char* type, const Shape& shape, const float* t, const char* verb) {
  const std::size_t count = count_of(shape);
  const auto found = std::count_if(t, t + count, [](float value) { return value < kInfinity; });
  return std::string("<boxwood.") + type + ": shape " + to_string(shape) + ", " + std::to_string(found) +
         " of " + std::to_string(count) + " " + verb + ">";
}

/// Lets the system take the pages of a block when it is short of them; those that it leaves need no clearing.
void lend_to_system(MemoryBlock& block) {
#if defined(__linux__) && defined(MADV_FREE)
  constexpr std::size_t kLargestPage = std::size_t(64) << 10;
  madvise(block.data(), block.size() / kLargestPage * kLargestPage, MADV_FREE);
#else
  (void)block;
#endif
}

}  // namespace

Block allocate_block(std::size_t size) try {
  constexpr std::size_t kMinSpareBytes = std::size_t(1) << 20;  // below, memory is cheap
  constexpr std::size_t kLine = 64, kHugePage = std::size_t(2) << 20;
  size = std::max<std::size_t>(size, 64);
  if (size < kMinSpareBytes) return std::make_shared<MemoryBlock>(size, kLine);

  // The last result that was let go of leaves its block, for one that is nearly as large.
  static std::atomic<MemoryBlock*> spare{nullptr};
  std::unique_ptr<MemoryBlock> buffer(spare.exchange(nullptr));
  if (!buffer || buffer->size() < size || buffer->size() / 2 > size)
    buffer = std::make_unique<MemoryBlock>(size, size >= kHugePage ? kHugePage : kLine);
  return Block(buffer.release(), [](MemoryBlock* old) {
    if (old->size() <= kMaxSpareBytes) {
      lend_to_system(*old);
      old = spare.exchange(old);
    }
    delete old;
  });
} catch (const std::bad_alloc&) {
  throw NoRoomForResults();
}

void expect_dimensions(nb::handle array, std::size_t count) {
  constexpr std::size_t kAlwaysThere = 32;
  if (count > kAlwaysThere && nb::cast<std::size_t>(array.attr("ndim")) != count)
    throw std::invalid_argument("an array of " + std::to_string(count) +
                                " dimensions is more than this NumPy has");
}

HitColumns::HitColumns(std::size_t count, Block& block) {
  Layout layout;
  const std::size_t at_t = layout.add<float>(count), at_primitive = layout.add<std::int32_t>(count),
                    at_geometry = layout.add<std::int32_t>(count),
                    at_instance = layout.add<std::int32_t>(count), at_part = layout.add<std::int32_t>(count),
                    at_uv = layout.add<float>(2 * count), at_normal = layout.add<float>(3 * count),
                    at_position = layout.add<float>(3 * count);
  block = layout.allocate();
  is_large = block->size() > kMinLargeBytes;
  t = column<float>(block, at_t);
  ids.primitive_id = column<std::int32_t>(block, at_primitive);
  ids.geometry_id = column<std::int32_t>(block, at_geometry);
  ids.instance_id = column<std::int32_t>(block, at_instance);
  part = column<std::int32_t>(block, at_part);
  uv = column<float>(block, at_uv, 2);
  normal = column<float>(block, at_normal, 3);
  position = column<float>(block, at_position, 3);
}

Hit HitColumns::read(std::size_t i) const {
  // Python may write while we read. What has been judged must not be fetched again.
  const auto once = [](const std::int32_t& number) {
    return static_cast<std::uint32_t>(const_cast<const volatile std::int32_t&>(number));
  };
  Hit hit;
  hit.t = t.data[i];
  hit.u = uv.data[2 * i];
  hit.v = uv.data[2 * i + 1];
  hit.normal = vec(normal.data + 3 * i);
  hit.instance_id = InstanceId(once(ids.instance_id.data[i]));
  hit.geometry_id = GeometryId(once(ids.geometry_id.data[i]));
  hit.primitive_id = PrimId(once(ids.primitive_id.data[i]));
  hit.part = once(part.data[i]);
  return hit;
}

AllHits::AllHits(const Shape& leading) : shape(leading) {
  Layout layout;
  const std::size_t at_offsets = layout.add<std::int64_t>(count_of(shape) + 1);
  offset_block = layout.allocate();
  offsets = column<std::int64_t>(offset_block, at_offsets);
}

void AllHits::make_room(std::size_t hits) {
  count = hits;
  columns = HitColumns(count, block);
}

void HitColumns::write(std::size_t begin, std::span<const Ray> rays, std::span<const Hit> hits) {
  // A few at a time: row by row into the nearest cache, and from there column by column to where they stay.
  constexpr std::size_t kStep = 128;
  struct Staged {
    // Three floats are stored by four; what is too much, the next three cover.
    float t[kStep], uv[2 * kStep], normal[3 * kStep + 1], position[3 * kStep + 1];
    std::int32_t instance_id[kStep], geometry_id[kStep], primitive_id[kStep], part[kStep];
  } s;
  const Lanes infinity = Lanes::all(kInfinity), nothing = Lanes::all(kNan);
  for (std::size_t first = 0; first < hits.size(); first += kStep) {
    const std::size_t count = std::min(kStep, hits.size() - first), row = begin + first;
    for (std::size_t i = 0; i < count; ++i) {
      const Hit& hit = hits[first + i];
      const Ray& ray = rays[first + i];
      s.t[i] = hit.t;
      std::memcpy(s.uv + 2 * i, part_of(hit, offsetof(Hit, u)), 2 * sizeof(float));
      // Without a branch, because who hits is hard to foresee.
      const Lanes t = Lanes::all(hit.t), normal = Lanes::load(part_of(hit, offsetof(Hit, normal)));
      select_less(t, infinity, normal, nothing).store(s.normal + 3 * i);
      const Lanes origin = Lanes::load(part_of(ray, offsetof(Ray, origin))),
                  direction = Lanes::load(part_of(ray, offsetof(Ray, direction)));
      select_less(t, infinity, origin + direction * t, nothing).store(s.position + 3 * i);
    }
    // The four numbers behind the normal, of four hits at once.
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
      const auto numbers = [&](std::size_t k) {
        return Lanes::load(part_of(hits[first + i + k], offsetof(Hit, instance_id)));
      };
      const Lanes even_low = zip_low(numbers(0), numbers(2)), even_high = zip_high(numbers(0), numbers(2)),
                  odd_low = zip_low(numbers(1), numbers(3)), odd_high = zip_high(numbers(1), numbers(3));
      zip_low(even_low, odd_low).store(s.instance_id + i);
      zip_high(even_low, odd_low).store(s.geometry_id + i);
      zip_low(even_high, odd_high).store(s.primitive_id + i);
      zip_high(even_high, odd_high).store(s.part + i);
    }
    for (; i < count; ++i) {
      const Hit& hit = hits[first + i];
      s.instance_id[i] = signed_id(hit.instance_id.value);
      s.geometry_id[i] = signed_id(hit.geometry_id.value);
      s.primitive_id[i] = signed_id(hit.primitive_id.value);
      s.part[i] = static_cast<std::int32_t>(hit.part);
    }
    const auto copy = [&](auto& column, const auto* from, std::size_t width = 1) {
      auto* const to = column.data + width * row;
      if (is_large)
        copy_past_cache(to, from, width * count);
      else
        std::memcpy(to, from, width * count * sizeof *from);
    };
    copy(t, s.t);
    copy(ids.primitive_id, s.primitive_id);
    copy(ids.geometry_id, s.geometry_id);
    copy(ids.instance_id, s.instance_id);
    copy(part, s.part);
    copy(uv, s.uv, 2);
    copy(normal, s.normal, 3);
    copy(position, s.position, 3);
  }
  if (is_large) finish_past_cache();
}

Points::Points(const Shape& leading) : shape(leading) {
  const std::size_t count = count_of(shape);
  Layout layout;
  const std::size_t at_distance = layout.add<float>(count), at_primitive = layout.add<std::int32_t>(count),
                    at_geometry = layout.add<std::int32_t>(count),
                    at_instance = layout.add<std::int32_t>(count), at_position = layout.add<float>(3 * count);
  block = layout.allocate();
  distance = column<float>(block, at_distance);
  ids.primitive_id = column<std::int32_t>(block, at_primitive);
  ids.geometry_id = column<std::int32_t>(block, at_geometry);
  ids.instance_id = column<std::int32_t>(block, at_instance);
  position = column<float>(block, at_position, 3);
}

void Points::write(std::size_t begin, std::span<const ScenePoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ScenePoint& p = points[i];
    distance.data[begin + i] = p.distance;
    ids.primitive_id.data[begin + i] = signed_id(p.primitive_id.value);
    ids.geometry_id.data[begin + i] = signed_id(p.geometry_id.value);
    ids.instance_id.data[begin + i] = signed_id(p.instance_id.value);
    put(position.data + 3 * (begin + i), p.distance < kInfinity ? p.position : splat(kNan));
  }
}

Surfaces::Surfaces(const Shape& leading) : shape(leading) {
  const std::size_t count = count_of(shape);
  Layout layout;
  const std::size_t at_position = layout.add<float>(3 * count), at_error = layout.add<float>(3 * count),
                    at_normal = layout.add<float>(3 * count), at_shading = layout.add<float>(3 * count),
                    at_uv = layout.add<float>(2 * count);
  block = layout.allocate();
  position = column<float>(block, at_position, 3);
  error = column<float>(block, at_error, 3);
  normal = column<float>(block, at_normal, 3);
  shading_normal = column<float>(block, at_shading, 3);
  uv = column<float>(block, at_uv, 2);
}

void Surfaces::write(std::size_t i, const Surface* surface) {
  put(position.data + 3 * i, surface ? surface->position : splat(kNan));
  put(error.data + 3 * i, surface ? surface->error : splat(kNan));
  put(normal.data + 3 * i, surface ? surface->normal : splat(kNan));
  put(shading_normal.data + 3 * i, surface ? surface->shading_normal : splat(kNan));
  uv.data[2 * i] = surface ? surface->uv.x : kNan;
  uv.data[2 * i + 1] = surface ? surface->uv.y : kNan;
}

Surface Surfaces::read(std::size_t i) const {
  Surface surface;
  surface.position = vec(position.data + 3 * i);
  surface.error = vec(error.data + 3 * i);
  surface.normal = vec(normal.data + 3 * i);
  surface.shading_normal = vec(shading_normal.data + 3 * i);
  return surface;
}

void bind_answers(nb::module_& module) {
  using nb::sig;

  // What Hits and AllHits have in common; `rows` is the leading shape of their columns.
  const auto bind_columns = [](auto& type, auto rows) {
    using Result = typename std::decay_t<decltype(type)>::Type;
    type.def_prop_ro(
        "t", [rows](Result& r) { return r.columns.t.get(r.block, rows(r)); },
        sig("def t(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Hit_t);
    type.def_prop_ro(
        "primitive_id", [rows](Result& r) { return r.columns.ids.primitive_id.get(r.block, rows(r)); },
        sig("def primitive_id(self) -> numpy.typing.NDArray[numpy.int32]"),
        "The triangle of the mesh, or the shape of its list, counted from 0; -1 for a miss.");
    type.def_prop_ro(
        "geometry_id", [rows](Result& r) { return r.columns.ids.geometry_id.get(r.block, rows(r)); },
        sig("def geometry_id(self) -> numpy.typing.NDArray[numpy.int32]"),
        "The geometry of the scene; -1 for a miss.");
    type.def_prop_ro(
        "instance_id", [rows](Result& r) { return r.columns.ids.instance_id.get(r.block, rows(r)); },
        sig("def instance_id(self) -> numpy.typing.NDArray[numpy.int32]"),
        "The instance of the scene; -1 for a miss.");
    type.def_prop_ro(
        "part", [rows](Result& r) { return r.columns.part.get(r.block, rows(r)); },
        sig("def part(self) -> numpy.typing.NDArray[numpy.int32]"), doc::Crossing_part);
    type.def_prop_ro(
        "uv", [rows](Result& r) { return r.columns.uv.get(r.block, rows(r)); },
        sig("def uv(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Crossing_u);
    type.def_prop_ro(
        "normal", [rows](Result& r) { return r.columns.normal.get(r.block, rows(r)); },
        sig("def normal(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Hit_normal);
    type.def_prop_ro(
        "position", [rows](Result& r) { return r.columns.position.get(r.block, rows(r)); },
        sig("def position(self) -> numpy.typing.NDArray[numpy.float32]"),
        "origin + t * direction; NaN for a miss.");
  };
  const auto shape_tuple = [](const Shape& shape) {
    nb::list sizes;
    for (const std::size_t size : shape) sizes.append(size);
    return nb::tuple(sizes);
  };
  const char* const shape_sig = "def shape(self) -> tuple[int, ...]";

  nb::class_<Hits> hits(
      module, "Hits", nb::is_weak_referenceable(),
      "Closest hits as columns, one row for each ray; a miss has t = inf, ids of -1, and NaN for "
      "normal and position.");
  bind_columns(hits, [](const Hits& h) { return h.shape; });
  hits.def_prop_ro(
          "shape", [shape_tuple](const Hits& h) { return shape_tuple(h.shape); }, sig(shape_sig),
          "Of the rays; () for a single one.")
      .def("__len__",
           [](const Hits& h) {
             if (h.shape.empty()) throw nb::type_error("len() of the hit of a single ray");
             return h.shape[0];
           })
      .def("__repr__", [](const Hits& h) { return describe("Hits", h.shape, h.columns.t.data, "hit"); });

  nb::class_<AllHits> all_hits(module, "AllHits", nb::is_weak_referenceable(),
                               "Every crossing of each ray as columns: the rows offsets[i] to offsets[i + "
                               "1], the end not included, are "
                               "those of ray i, by t.");
  bind_columns(all_hits, [](const AllHits& h) { return Shape{h.count}; });
  all_hits
      .def_prop_ro(
          "offsets", [](AllHits& h) { return h.offsets.get(h.offset_block, Shape{count_of(h.shape) + 1}); },
          sig("def offsets(self) -> numpy.typing.NDArray[numpy.int64]"),
          "(k + 1,) for k rays; rays of more than one dimension are counted row by row.")
      .def_prop_ro(
          "shape", [shape_tuple](const AllHits& h) { return shape_tuple(h.shape); }, sig(shape_sig),
          "Of the rays.")
      .def(
          "__len__", [](const AllHits& h) { return h.count; }, "How many crossings there are.")
      .def("__repr__", [](const AllHits& h) {
        return "<boxwood.AllHits: " + std::to_string(h.count) + " crossings of rays of shape " +
               to_string(h.shape) + ">";
      });

  nb::class_<Points> points(
      module, "Points", nb::is_weak_referenceable(),
      "Nearest points as columns; none within reach has distance = inf, ids of -1, position NaN.");
  points
      .def_prop_ro(
          "distance", [](Points& p) { return p.distance.get(p.block, p.shape); },
          sig("def distance(self) -> numpy.typing.NDArray[numpy.float32]"), "From the point asked for.")
      .def_prop_ro(
          "position", [](Points& p) { return p.position.get(p.block, p.shape); },
          sig("def position(self) -> numpy.typing.NDArray[numpy.float32]"), "On the surface.")
      .def_prop_ro(
          "primitive_id", [](Points& p) { return p.ids.primitive_id.get(p.block, p.shape); },
          sig("def primitive_id(self) -> numpy.typing.NDArray[numpy.int32]"), "As in Hits.")
      .def_prop_ro(
          "geometry_id", [](Points& p) { return p.ids.geometry_id.get(p.block, p.shape); },
          sig("def geometry_id(self) -> numpy.typing.NDArray[numpy.int32]"), "As in Hits.")
      .def_prop_ro(
          "instance_id", [](Points& p) { return p.ids.instance_id.get(p.block, p.shape); },
          sig("def instance_id(self) -> numpy.typing.NDArray[numpy.int32]"), "As in Hits.")
      .def_prop_ro(
          "shape", [shape_tuple](const Points& p) { return shape_tuple(p.shape); }, sig(shape_sig),
          "Of the points asked for.")
      .def("__repr__", [](const Points& p) { return describe("Points", p.shape, p.distance.data, "found"); });

  nb::class_<Surfaces> surfaces(module, "Surfaces", nb::is_weak_referenceable(),
                                "Places of hits as columns, in world space; NaN for a miss.");
  surfaces
      .def_prop_ro(
          "position", [](Surfaces& s) { return s.position.get(s.block, s.shape); },
          sig("def position(self) -> numpy.typing.NDArray[numpy.float32]"), "On the surface, within `error`.")
      .def_prop_ro(
          "error", [](Surfaces& s) { return s.error.get(s.block, s.shape); },
          sig("def error(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Surface_error)
      .def_prop_ro(
          "normal", [](Surfaces& s) { return s.normal.get(s.block, s.shape); },
          sig("def normal(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Surface_normal)
      .def_prop_ro(
          "shading_normal", [](Surfaces& s) { return s.shading_normal.get(s.block, s.shape); },
          sig("def shading_normal(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Surface_shading_normal)
      .def_prop_ro(
          "uv", [](Surfaces& s) { return s.uv.get(s.block, s.shape); },
          sig("def uv(self) -> numpy.typing.NDArray[numpy.float32]"), doc::Surface_uv)
      .def_prop_ro(
          "shape", [shape_tuple](const Surfaces& s) { return shape_tuple(s.shape); }, sig(shape_sig),
          "Of the rays.")
      .def(
          "spawn",
          [](const Surfaces& s, nb::handle directions, nb::handle threads) {
            // Every place may send out several rays: (k, 3) places and (n, k, 3) directions.
            Rows rows("directions", directions, {3});
            if (rows.shape().size() < s.shape.size() ||
                !std::equal(s.shape.rbegin(), s.shape.rend(), rows.shape().rbegin()))
              throw std::invalid_argument("directions: got leading shape " + to_string(rows.shape()) +
                                          ", expected it to end with the shape of the surfaces, " +
                                          to_string(s.shape));
            const std::size_t count = rows.count(), places = count_of(s.shape);
            Layout layout;
            layout.add<float>(3 * count);
            const Block block = layout.allocate();
            float* const origins = reinterpret_cast<float*>(block->data());
            run_in_parts(count, threads, [&](std::size_t begin, std::size_t end) {
              std::vector<float> towards(3 * (end - begin));
              rows.read(begin, end - begin, towards.data(), 3);
              for (std::size_t i = begin; i < end; ++i)
                put(origins + 3 * i, s.read(i % places).spawn(vec(&towards[3 * (i - begin)])).origin);
            });
            return make_array(block, origins, rows.shape(), 3);
          },
          nb::arg("directions").none(), nb::kw_only(), nb::arg("threads").none() = 0,
          sig("def spawn(self, directions: numpy.typing.ArrayLike, *, threads: int = 0) -> "
              "numpy.typing.NDArray[numpy.float32]"),
          (std::string(doc::Surface_spawn) +
           "\n\nReturns the origins of these rays, of the shape of `directions`, which ends with that of the "
           "surfaces:\n(n, k, 3) sends n rays from each of k places.")
              .c_str());

  def_pickle(hits);
  def_pickle(all_hits);
  def_pickle(points);
  def_pickle(surfaces);
}

}  // namespace boxwood::python
