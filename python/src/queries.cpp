// queries.cpp: how does a question in arrays become a stream of rays, and the answers columns?
#include "queries.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>

#include "answers.h"
#include "boxwood/core/lanes.h"
#include "boxwood/scene/parts.h"
#include "docstrings.h"

namespace boxwood::python {

RayRows::RayRows(nb::handle origins, nb::handle directions, nb::handle t_min, nb::handle t_max)
    : origins_("origins", origins, {3}),
      directions_("directions", directions, {3}),
      t_min_("t_min", t_min, {}),
      t_max_("t_max", t_max, {}),
      shape_(broadcast_shapes({&origins_, &directions_, &t_min_, &t_max_})) {
  for (Rows* rows : {&origins_, &directions_, &t_min_, &t_max_}) rows->broadcast_to(shape_);
}

void RayRows::fill(std::size_t begin, std::span<Ray> rays) const {
  if (rays.empty()) return;
  const char *origin = origins_.packed_triples(), *direction = directions_.packed_triples();
  const std::optional<float> t_min = t_min_.constant(), t_max = t_max_.constant();
  if (origin && direction && t_min && t_max) {
    // The usual arrays: three floats by four, but for the last, behind which there may be nothing.
    constexpr std::size_t kRow = 3 * sizeof(float);
    origin += begin * kRow;
    direction += begin * kRow;
    for (Ray& ray : rays.first(rays.size() - 1)) {
      const Lanes from = Lanes::load(origin), along = Lanes::load(direction);
      char* const bytes = reinterpret_cast<char*>(&ray);
      from.store(bytes + offsetof(Ray, origin));
      ray.t_min = *t_min;
      along.store(bytes + offsetof(Ray, direction));
      ray.t_max = *t_max;
      origin += kRow;
      direction += kRow;
    }
    rays.back() = {{}, *t_min, {}, *t_max};
    std::memcpy(&rays.back().origin, origin, kRow);
    std::memcpy(&rays.back().direction, direction, kRow);
    return;
  }

  // A Ray is eight floats (core/ray.h). A few at a time, so that the nearest cache holds them through four
  // reads.
  constexpr std::size_t kStride = sizeof(Ray) / sizeof(float), kStep = 256;
  for (std::size_t done = 0; done < rays.size(); done += kStep) {
    const std::size_t count = std::min(kStep, rays.size() - done);
    Ray& first = rays[done];
    origins_.read(begin + done, count, &first.origin.x, kStride);
    t_min_.read(begin + done, count, &first.t_min, kStride);
    directions_.read(begin + done, count, &first.direction.x, kStride);
    t_max_.read(begin + done, count, &first.t_max, kStride);
  }
}

namespace {

Hits closest_hit(const SceneObject& s, nb::handle origins, nb::handle directions, nb::handle t_min,
                 nb::handle t_max, nb::handle threads) {
  const RayRows rows(origins, directions, t_min, t_max);
  Hits hits(rows.shape());
  run_stream(rows.count(), threads, [&](const Stream& stream) {
    stream_closest_hit(
        s.scene, stream, [&](std::size_t begin, std::span<Ray> rays) { rows.fill(begin, rays); },
        [&](std::size_t begin, std::span<const Ray> rays, std::span<const Hit> found) {
          hits.columns.write(begin, rays, found);
        });
  });
  return hits;
}

nb::object any_hit(const SceneObject& s, nb::handle origins, nb::handle directions, nb::handle t_min,
                   nb::handle t_max, nb::handle threads) {
  const RayRows rows(origins, directions, t_min, t_max);
  Layout layout;
  layout.add<bool>(rows.count());
  const Block block = layout.allocate();
  bool* const is_hit = reinterpret_cast<bool*>(block->data());
  run_stream(rows.count(), threads, [&](const Stream& stream) {
    stream_any_hit(
        s.scene, stream, [&](std::size_t begin, std::span<Ray> rays) { rows.fill(begin, rays); },
        [&](std::size_t begin, std::span<const Ray>, std::span<const bool> found) {
          std::copy(found.begin(), found.end(), is_hit + begin);
        });
  });
  return make_array(block, is_hit, rows.shape());
}

nb::object count_hits(const SceneObject& s, nb::handle origins, nb::handle directions, nb::handle t_min,
                      nb::handle t_max, nb::handle threads) {
  const RayRows rows(origins, directions, t_min, t_max);
  Layout layout;
  layout.add<std::int64_t>(rows.count());
  const Block block = layout.allocate();
  std::int64_t* const counts = reinterpret_cast<std::int64_t*>(block->data());
  run_stream(rows.count(), threads, [&](const Stream& stream) {
    stream_count_hits(
        s.scene, stream, [&](std::size_t begin, std::span<Ray> rays) { rows.fill(begin, rays); },
        [&](std::size_t begin, std::span<const Ray>, std::span<const std::size_t> found) {
          std::copy(found.begin(), found.end(), counts + begin);
        });
  });
  return make_array(block, counts, rows.shape());
}

AllHits all_hits(const SceneObject& s, nb::handle origins, nb::handle directions, nb::handle t_min,
                 nb::handle t_max, nb::handle threads) {
  const RayRows rows(origins, directions, t_min, t_max);
  AllHits all(rows.shape());
  all.offsets.data[0] = 0;

  // Nobody knows beforehand how many there are: keep what each chunk finds, by its first ray.
  std::mutex mutex;
  std::map<std::size_t, std::vector<Hit>> chunks;
  run_stream(rows.count(), threads, [&](const Stream& stream) {
    stream_all_hits(
        s.scene, stream, [&](std::size_t begin, std::span<Ray> rays) { rows.fill(begin, rays); },
        [&](std::size_t begin, std::span<const Ray> rays, std::span<const std::size_t> offsets,
            std::span<const Hit> hits) {
          for (std::size_t i = 0; i < rays.size(); ++i)
            all.offsets.data[begin + i + 1] = static_cast<std::int64_t>(offsets[i + 1] - offsets[i]);
          std::vector<Hit> mine(hits.begin(), hits.end());
          std::lock_guard lock(mutex);
          chunks.emplace(begin, std::move(mine));
        });

    // Add up the counts, then write the columns and let go of the chunks.
    for (std::size_t i = 0; i < rows.count(); ++i) all.offsets.data[i + 1] += all.offsets.data[i];
    all.make_room(static_cast<std::size_t>(all.offsets.data[rows.count()]));
    std::vector<std::pair<std::size_t, std::vector<Hit>*>> in_order;
    for (auto& [begin, hits] : chunks) in_order.emplace_back(begin, &hits);
    parallel_for(*stream.executor, 0, in_order.size(), 1, [&](std::size_t c) {
      const std::size_t begin = in_order[c].first,
                        end = c + 1 < in_order.size() ? in_order[c + 1].first : rows.count();
      std::vector<Hit>& hits = *in_order[c].second;
      std::vector<Ray> rays(end - begin), ray_of_hit;
      rows.fill(begin, rays);
      ray_of_hit.reserve(hits.size());
      for (std::size_t i = begin; i < end; ++i)
        ray_of_hit.insert(ray_of_hit.end(),
                          static_cast<std::size_t>(all.offsets.data[i + 1] - all.offsets.data[i]),
                          rays[i - begin]);
      all.columns.write(static_cast<std::size_t>(all.offsets.data[begin]), ray_of_hit, hits);
      hits = {};
    });
  });
  return all;
}

Points closest_point(const SceneObject& s, nb::handle points, nb::handle max_distance, nb::handle threads) {
  Rows point_rows("points", points, {3}), distance_rows("max_distance", max_distance, {});
  const Shape shape = broadcast_shapes({&point_rows, &distance_rows});
  point_rows.broadcast_to(shape);
  distance_rows.broadcast_to(shape);
  Points found(shape);
  run_stream(count_of(shape), threads, [&](const Stream& stream) {
    stream_closest_point(
        s.scene, stream,
        [&](std::size_t begin, std::span<SearchPoint> asked) {
          constexpr std::size_t kStride = sizeof(SearchPoint) / sizeof(float);
          point_rows.read(begin, asked.size(), &asked[0].point.x, kStride);
          distance_rows.read(begin, asked.size(), &asked[0].max_distance, kStride);
        },
        [&](std::size_t begin, std::span<const SearchPoint>, std::span<const ScenePoint> nearest) {
          found.write(begin, nearest);
        });
  });
  return found;
}

Surfaces surface_at(const SceneObject& s, nb::handle origins, nb::handle directions, const Hits& hits,
                    nb::handle threads) {
  const RayRows rows(origins, directions, nb::float_(0.0), nb::float_(0.0));
  if (rows.shape() != hits.shape)
    throw std::invalid_argument("hits: got shape " + to_string(hits.shape) + ", expected " +
                                to_string(rows.shape()) + ", that of the rays");

  // Another scene's hits name things that are not here, and so may columns that somebody has written to, even
  // while they are read: each hit is looked at once, and then judged.
  const Scene::Parts& parts = s.scene.parts();
  const auto is_ours = [&](const Hit& hit) {
    constexpr std::uint32_t kCuboidSides = 6;
    if (hit.instance_id.value >= parts.instances.size() ||
        parts.instances[hit.instance_id.value].geometry != hit.geometry_id)
      return false;
    const Geometry& geometry = parts.desc.geometries[hit.geometry_id.value];
    const bool is_cuboid = std::holds_alternative<std::vector<Cuboid>>(geometry.shapes);
    return hit.primitive_id.value < primitive_count(geometry) && (!is_cuboid || hit.part < kCuboidSides);
  };
  std::mutex mutex;
  std::size_t first_foreign = rows.count();

  Surfaces surfaces(rows.shape());
  run_in_parts(rows.count(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays(end - begin);
    rows.fill(begin, rays);
    for (std::size_t i = begin; i < end; ++i) {
      const Hit hit = hits.columns.read(i);
      const bool is_foreign = hit.is_hit() && !is_ours(hit);
      if (is_foreign) {
        std::lock_guard lock(mutex);
        first_foreign = std::min(first_foreign, i);
      }
      if (!hit.is_hit() || is_foreign) {
        surfaces.write(i, nullptr);
        continue;
      }
      const Surface surface = boxwood::surface_at(s.scene, rays[i - begin], hit);
      surfaces.write(i, &surface);
    }
  });
  if (first_foreign < rows.count())
    throw std::invalid_argument("hits: hit " + std::to_string(first_foreign) +
                                " is on nothing of this scene");
  return surfaces;
}

constexpr char kRayArguments[] =
    "\n\norigins, directions: arrays of shape (..., 3); t_min, t_max: numbers or arrays of shape (...). They "
    "broadcast together.\nA direction need not be a unit vector, t counts in multiples of it. threads: 0 "
    "means "
    "all. Ctrl-C ends a long call.";

#define BOXWOOD_RAY_SIGNATURE(name, result)                                                                \
  nb::sig("def " name                                                                                      \
          "(self, origins: numpy.typing.ArrayLike, directions: numpy.typing.ArrayLike, *, t_min: "         \
          "numpy.typing.ArrayLike = 0.0, t_max: numpy.typing.ArrayLike = float('inf'), threads: int = 0) " \
          "-> " result)

}  // namespace

void bind_queries(nb::class_<SceneObject>& scene) {
  using nb::arg;
  const nb::object zero = nb::float_(0.0), infinity = nb::float_(std::numeric_limits<double>::infinity());
  const auto def_rays = [&](const char* name, auto function, const char* doc, const auto& signature) {
    scene.def(name, function, arg("origins").none(), arg("directions").none(), nb::kw_only(),
              arg("t_min").none() = zero, arg("t_max").none() = infinity, arg("threads").none() = 0,
              signature, (std::string(doc) + kRayArguments).c_str());
  };
  def_rays("closest_hit", &closest_hit, doc::Scene_closest_hit, BOXWOOD_RAY_SIGNATURE("closest_hit", "Hits"));
  def_rays("any_hit", &any_hit, doc::Scene_any_hit,
           BOXWOOD_RAY_SIGNATURE("any_hit", "numpy.typing.NDArray[numpy.bool_]"));
  def_rays("all_hits", &all_hits, doc::Scene_all_hits, BOXWOOD_RAY_SIGNATURE("all_hits", "AllHits"));
  def_rays("count_hits", &count_hits, doc::Scene_count_hits,
           BOXWOOD_RAY_SIGNATURE("count_hits", "numpy.typing.NDArray[numpy.int64]"));
  scene.def("closest_point", &closest_point, arg("points").none(), nb::kw_only(),
            arg("max_distance").none() = infinity, arg("threads").none() = 0,
            nb::sig("def closest_point(self, points: numpy.typing.ArrayLike, *, max_distance: "
                    "numpy.typing.ArrayLike = float('inf'), threads: int = 0) -> Points"),
            (std::string(doc::Scene_closest_point) + "\n\npoints: an array of shape (..., 3); max_distance: "
                                                     "a number or an array of shape (...). threads: 0 "
                                                     "means all.")
                .c_str());
  scene.def(
      "surface_at", &surface_at, arg("origins").none(), arg("directions").none(), arg("hits"), nb::kw_only(),
      arg("threads").none() = 0,
      nb::sig("def surface_at(self, origins: numpy.typing.ArrayLike, directions: numpy.typing.ArrayLike, "
              "hits: Hits, *, threads: int = 0) -> Surfaces"),
      "Works out the places of `hits`, which closest_hit returned for these rays: with error bounds, "
      "shading normals, and\norigins for the next rays (Surfaces.spawn).");
}

}  // namespace boxwood::python
