// yardstick.cpp: what would the same rays cost a C++ program?
//
// For `python -m boxwood.bench` and the tests: the batch call of scene.h on rays and hits that lie in memory
// as it likes them, so that what the arrays add can be told.
#include <chrono>

#include "queries.h"

namespace boxwood::python {
namespace {

double time_closest_hit(const SceneObject& s, nb::handle origins, nb::handle directions, nb::handle threads) {
  const RayRows rows(origins, directions, nb::float_(0.0), nb::float_(kInfinity));
  std::vector<Ray> rays(rows.count());
  std::vector<Hit> hits(rows.count());
  rows.fill(0, rays);
  Executor& executor = executor_of(threads);
  nb::gil_scoped_release no_gil;
  const auto start = std::chrono::steady_clock::now();
  s.scene.closest_hit(rays, hits, &executor);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void bind_yardstick(nb::module_& module) {
  module.def(
      "time_closest_hit", &time_closest_hit, nb::arg("scene"), nb::arg("origins").none(),
      nb::arg("directions").none(), nb::arg("threads").none() = 0,
      nb::sig("def time_closest_hit(scene: Scene, origins: numpy.typing.ArrayLike, directions: "
              "numpy.typing.ArrayLike, threads: int = 0) -> float"),
      "Seconds that Scene::closest_hit of C++ takes for these rays, arrays in and arrays out left aside.");
}

}  // namespace boxwood::python
