// queries.h: what do the questions in arrays share?
#pragma once

#include <nanobind/nanobind.h>

#include "boxwood/core/ray.h"
#include "rows.h"
#include "running.h"
#include "scene_type.h"

namespace boxwood::python {

/// The rays of four arguments that broadcast together.
class RayRows {
 public:
  RayRows(nb::handle origins, nb::handle directions, nb::handle t_min, nb::handle t_max);

  const Shape& shape() const { return shape_; }
  std::size_t count() const { return count_of(shape_); }
  /// Writes the rays from `begin` on. Any thread may call, with or without the GIL.
  void fill(std::size_t begin, std::span<Ray> rays) const;

 private:
  Rows origins_, directions_, t_min_, t_max_;
  Shape shape_;
};

void bind_queries(nb::class_<SceneObject>& scene);
void bind_yardstick(nb::module_& module);

}  // namespace boxwood::python
