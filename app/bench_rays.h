// bench_rays.h: which rays is a scene measured with?
//
// Sets that renderers send, made once for each scene and asked of every engine: camera rays in tiles, short
// shadow rays, two diffuse bounces, and rays that have nothing to do with each other. Or a user's own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench_engine.h"
#include "boxwood/scene/scene.h"

namespace boxwood::app {

struct RaySet {
  std::string name;
  Question question = Question::closest_hit;
  bool is_coherent = false;
  std::vector<Ray> rays;
};

/// The names of the sets that make_ray_sets knows, in its order.
inline constexpr std::string_view kRaySetNames[] = {"primary", "occlusion", "bounce1", "bounce2", "random"};

/// The `names` among kRaySetNames, of about `count` rays each:
///   primary    from the camera of `desc`, or one that frames it, through the pixels' centers of a square
///              picture, in tiles of 8 x 8;
///   occlusion  any hit: from where those hit, cosine-distributed, a tenth of the scene's diagonal long;
///   bounce1    closest hit: the same without an end; bounce2: from where those hit;
///   random     from anywhere in the scene's box, in any direction.
/// A set that has nowhere to start from, because the rays before it all missed, is left out.
std::vector<RaySet> make_ray_sets(const Scene& scene, const SceneDesc& desc, std::size_t count,
                                  const std::vector<std::string>& names, Executor& executor);

/// The rays of a file of little-endian float32 records: origin x, y, z, t_min, direction x, y, z, t_max. The
/// set is called after the file's stem. Throws FileError, which names the file and the ray: when its size is
/// not a multiple of 32 bytes, when a ray asks nothing (a NaN, an origin or direction that is not finite, a
/// direction of zero or beyond 2^-96 to 2^96), or when the stem is one of kRaySetNames.
RaySet read_rays(const std::string& path);

}  // namespace boxwood::app
