// layer.h: what else is worth knowing about a pixel, beside its light?
//
// "Arbitrary output variables", for denoisers, compositors and the curious. Some are means over the samples
// of the pixel, like light itself, and see the scene through the same filter and lens; names of things have
// no mean and are those behind the middle of the pixel; the others tell of the sampling.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/core/ray.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

enum class Layer {
  albedo,    ///< Mean: the base color of what is seen; black where nothing is.
  normal,    ///< Mean: its shading normal in world space; 0 where nothing is seen.
  depth,     ///< Mean over what is seen: the distance from the eye; 0 where nothing is.
  position,  ///< Mean over what is seen: the point in world space; 0 where nothing is.
  object,    ///< Name: 1 + the number of the instance; 0 where nothing is seen. Exact below 2^24.
  material,  ///< Name: 1 + the number of the material; 0 for the default material and for nothing.
  samples,   ///< How many samples the pixel got.
  variance,  ///< Of the pixel's brightness (the mean of its channels), by two halves of its samples.
};

std::span<const Layer> all_layers();
/// "albedo", "normal" ...; and back. Throws std::invalid_argument for a name that is not one of them.
std::string_view layer_name(Layer layer);
Layer layer_from_name(std::string_view name);
/// What its channels are called in a file: "albedo.R", ...
std::vector<std::string> layer_channels(Layer layer);

/// Whether the layer is a mean over samples.
bool is_mean(Layer layer);
/// Whether the layer is the name of a thing.
bool is_name(Layer layer);

/// Looks at what camera rays hit, for the layers that are means.
class Features {
 public:
  /// Keeps a reference to `scene`; of `layers` it looks after those that are means, in their order.
  Features(const Scene& scene, std::span<const Layer> layers);

  /// Those layers.
  std::span<const Layer> layers() const { return layers_; }
  /// Floats for each ray: the channels of all layers().
  std::size_t channels() const { return channels_; }
  /// Whether a ray that hits nothing counts for the layer.
  static bool counts_misses(Layer layer) { return layer == Layer::albedo || layer == Layer::normal; }

  /// Traces the rays and fills `values` (channels() for each) and `is_hit`.
  void look(std::span<const Ray> rays, std::span<float> values, std::span<bool> is_hit) const;

 private:
  const Scene& scene_;
  std::vector<Layer> layers_;
  std::size_t channels_ = 0;
};

/// The name, as a layer has it, of what `ray` hits.
float name_of_hit(const Scene& scene, const Ray& ray, Layer layer);

}  // namespace boxwood::render
