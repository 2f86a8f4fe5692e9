// camera.h: which ray belongs to a point of the picture?
//
// A pinhole, or a thin lens: all rays of one film point meet in one point of the plane of focus, and each
// starts elsewhere on the lens. Or rays that are all parallel. A scene without a camera gets one that fills
// the picture with everything that is shown.
#pragma once

#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// Makes the rays of a picture of `width` x `height` pixels.
/// Directions are of unit length, so t is a distance.
class Lens {
 public:
  /// Throws std::invalid_argument when the camera is not finite, or its angle not between 0 and 180 degrees.
  Lens(const Camera& camera, int width, int height);

  /// `film` in pixels: (0, 0) is the upper left corner of the picture, (width, height) the lower right one.
  /// `lens` is uniform in the unit square; a pinhole does not look at it.
  Ray ray(Vec2 film, Vec2 lens) const;

 private:
  Affine3 world_from_camera_;
  Vec3 corner_, step_right_, step_down_;  // on the plane z = -1 of the camera
  float lens_radius_, focus_distance_;
  bool is_orthographic_;
};

/// How wide a pixel in the middle of the picture looks, in radians; 0 where rays are parallel.
float pixel_angle(const Camera& camera, int width, int height);

/// The scene's own camera, else one that frames it.
Camera choose_camera(const SceneDesc& desc, int width, int height);

/// A camera that looks down a little at the front and the right side (+z, +x) of what `desc` shows, from as
/// near as keeps all of it within the picture but for a small margin. Cost: one pass over the vertices.
Camera frame_camera(const SceneDesc& desc, int width, int height);

}  // namespace boxwood::render
