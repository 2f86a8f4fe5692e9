// boxwood.h: what does one include bring? The rooms from core to scene; the order is the floor plan.
//
// Read it from top to bottom: each room stands on those before it. The others have doors of their own:
// boxwood/reference/ (the rivals), boxwood/gallery/gallery.h (scenes made here), boxwood/io/load.h and
// boxwood/io/image.h (files), boxwood/render/render.h (pictures).
#pragma once

// clang-format off: the order carries meaning

// Floor 0. core: vectors, boxes, rays, hits, threads, errors.
#include "boxwood/core/affine.h"
#include "boxwood/core/box.h"
#include "boxwood/core/error.h"
#include "boxwood/core/hit.h"
#include "boxwood/core/id.h"
#include "boxwood/core/morton.h"
#include "boxwood/core/parallel.h"
#include "boxwood/core/prepared_ray.h"
#include "boxwood/core/progress.h"
#include "boxwood/core/radix_sort.h"
#include "boxwood/core/random.h"
#include "boxwood/core/ray.h"
#include "boxwood/core/vec.h"

// Floor 1. shape: what is hit.
#include "boxwood/shape/concept.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/disk.h"
#include "boxwood/shape/gate.h"
#include "boxwood/shape/instance.h"
#include "boxwood/shape/quad.h"
#include "boxwood/shape/shape.h"
#include "boxwood/shape/sphere.h"
#include "boxwood/shape/triangle.h"

// Floor 1. tree: what organises it.
#include "boxwood/tree/bvh.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/metrics.h"
#include "boxwood/tree/validate.h"
#include "boxwood/tree/wide.h"

// Floor 2. build: make a tree.
#include "boxwood/build/build.h"
#include "boxwood/build/options.h"

// Floor 2. query: ask it.
#include "boxwood/query/all_hits.h"
#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/closest_point.h"
#include "boxwood/query/distance.h"
#include "boxwood/query/group.h"
#include "boxwood/query/nearest.h"
#include "boxwood/query/overlap.h"
#include "boxwood/query/traverse.h"
#include "boxwood/query/traverse_wide.h"

// Floor 3. scene: the hall.
#include "boxwood/scene/description.h"
#include "boxwood/scene/image.h"
#include "boxwood/scene/scene.h"
#include "boxwood/scene/srgb.h"
#include "boxwood/scene/stream.h"
#include "boxwood/scene/surface.h"
