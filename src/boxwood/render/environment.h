// environment.h: which light comes from a picture of the surroundings, and where is it bright?
//
// The picture is a function that is constant over its pixels as far as sampling goes: a row is chosen by how
// much light it holds, then a pixel of the row, then a point of the pixel. Pharr, Jakob and Humphreys,
// Physically Based Rendering, 4th edition, 12.5 and appendix A.5.
#pragma once

#include <vector>

#include "boxwood/scene/description.h"

namespace boxwood::render {

class EnvironmentLight {
 public:
  /// Keeps a reference. Pixels that are negative or not finite count as black.
  explicit EnvironmentLight(const Environment& environment);

  /// The radiance from the unit vector `direction`, in world space.
  Vec3 radiance(Vec3 direction) const;

  struct Sample {
    Vec3 direction;  ///< Towards the light; unit length, world space.
    float pdf;       ///< Per solid angle; 0 when there is no light at all.
  };
  Sample sample(Vec2 u) const;
  /// The density with which sample() finds `direction`.
  float pdf(Vec3 direction) const;

  /// The irradiance that light of the mean radiance from everywhere would cause.
  float strength() const { return strength_; }

 private:
  Vec3 pixel(int x, int y) const;
  Vec2 picture_point(Vec3 local) const;
  float density(int x, int y) const;

  const Environment& environment_;
  Affine3 world_from_environment_, environment_from_world_;
  int width_, height_;
  std::vector<float> running_;       // in each row, the sum up to and with each pixel
  std::vector<double> running_row_;  // the sum up to and with each row
  float strength_ = 0;
};

}  // namespace boxwood::render
