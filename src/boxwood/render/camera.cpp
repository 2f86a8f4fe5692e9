#include "boxwood/render/camera.h"

#include <stdexcept>
#include <string>

#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

constexpr float kDegree = 3.14159265358979f / 180;

/// Calls visit(point) for points whose hull holds everything that is shown: vertices, and the corners of
/// other shapes' boxes.
template <class Visit>
void for_each_hull_point(const SceneDesc& desc, const Visit& visit) {
  for (const Instance& instance : placed_instances(desc)) {
    const Affine3& world_from_object = instance.world_from_object;
    std::visit(
        [&](const auto& shapes) {
          if constexpr (std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>) {
            for (const auto& triangle : shapes.indices)
              for (const std::uint32_t vertex : triangle)
                visit(world_from_object.point(shapes.positions[vertex]));
          } else {
            for (const auto& shape : shapes) {
              const Box3 box = shape.box();
              if (box.is_empty()) continue;
              for (int which = 0; which < 8; ++which) visit(world_from_object.point(box.corner(which)));
            }
          }
        },
        desc.geometries[instance.geometry.value].shapes);
  }
}

/// Half the width and half the height of a picture whose shorter side is twice `half` long.
Vec2 half_sides(float half, int width, int height) {
  const float shorter = static_cast<float>(std::min(width, height));
  return {half * static_cast<float>(width) / shorter, half * static_cast<float>(height) / shorter};
}

/// The same for the picture at distance 1. The angle spans the shorter side.
Vec2 half_extent(float fov_deg, int width, int height) {
  return half_sides(std::tan(0.5f * fov_deg * kDegree), width, height);
}

}  // namespace

Lens::Lens(const Camera& camera, int width, int height)
    : world_from_camera_(camera.world_from_camera),
      lens_radius_(camera.lens_radius),
      focus_distance_(camera.focus_distance),
      is_orthographic_(camera.orthographic_size > 0) {
  const Affine3& m = camera.world_from_camera;
  if (!(camera.fov_deg > 0 && camera.fov_deg < 180))
    throw std::invalid_argument("camera: the field of view is " + std::to_string(camera.fov_deg) +
                                " degrees, expected more than 0 and less than 180");
  if (!(camera.orthographic_size >= 0 && camera.orthographic_size < kInfinity))
    throw std::invalid_argument("camera: expected a finite orthographic size of 0 or more");
  if (!is_finite(m.x) || !is_finite(m.y) || !is_finite(m.z) || !is_finite(m.origin) || determinant(m) == 0)
    throw std::invalid_argument("camera: its transform is not finite or flattens space");
  if (!(lens_radius_ >= 0) || (lens_radius_ > 0 && !(focus_distance_ > 0)))
    throw std::invalid_argument("camera: expected a lens radius of 0 or more, and a focus distance above 0");

  const Vec2 half = is_orthographic_ ? half_sides(0.5f * camera.orthographic_size, width, height)
                                     : half_extent(camera.fov_deg, width, height);
  corner_ = {-half.x, half.y, -1};
  step_right_ = {2 * half.x / static_cast<float>(width), 0, 0};
  step_down_ = {0, -2 * half.y / static_cast<float>(height), 0};
}

Ray Lens::ray(Vec2 film, Vec2 lens) const {
  Vec3 direction = corner_ + step_right_ * film.x + step_down_ * film.y;
  Vec3 origin{0, 0, 0};
  if (is_orthographic_) {
    origin = {direction.x, direction.y, 0};
    direction = {0, 0, -1};
  } else if (lens_radius_ > 0) {
    // Turn the ray so that it still meets the point in focus, but starts elsewhere on the lens.
    const Vec2 disk = uniform_disk(lens);
    origin = Vec3{disk.x, disk.y, 0} * lens_radius_;
    direction = direction * focus_distance_ - origin;
  }
  Ray ray;
  ray.origin = world_from_camera_.point(origin);
  ray.direction = normalize(world_from_camera_.vector(direction));
  return ray;
}

float pixel_angle(const Camera& camera, int width, int height) {
  if (camera.orthographic_size > 0) return 0;
  return 2 * half_extent(camera.fov_deg, width, height).x / static_cast<float>(width);
}

Camera choose_camera(const SceneDesc& desc, int width, int height) {
  return desc.camera ? *desc.camera : frame_camera(desc, width, height);
}

Camera frame_camera(const SceneDesc& desc, int width, int height) {
  Camera camera;
  camera.fov_deg = 30;
  // Three quarters from the right, a little from above: no axis of the model is seen end-on.
  const Affine3 turn = Affine3::look_at({0.55f, 0.38f, 1}, {0, 0, 0}, {0, 1, 0});
  camera.world_from_camera = turn;

  // A point p, in axes turned like the camera, is within the right and left side of the view from c when
  //     |p.x - c.x| <= h (c.z - p.z)
  // where h is half the width at distance 1. Over all points this asks for c.z >= (a + b) / 2h, with a =
  // max(p.x + h p.z) and b = max(h p.z - p.x), and c.x = (a - b) / 2 leaves the same margin on both sides. Up
  // and down alike.
  const Vec2 half = half_extent(camera.fov_deg * 0.9f, width, height);
  double right = -kInfinity, left = -kInfinity, top = -kInfinity, bottom = -kInfinity;
  double nearest = -kInfinity, farthest = kInfinity;
  bool is_empty = true;
  for_each_hull_point(desc, [&](Vec3 p) {
    const double x = dot(turn.x, p), y = dot(turn.y, p), z = dot(turn.z, p);
    right = std::max(right, x + half.x * z);
    left = std::max(left, half.x * z - x);
    top = std::max(top, y + half.y * z);
    bottom = std::max(bottom, half.y * z - y);
    nearest = std::max(nearest, z);
    farthest = std::min(farthest, z);
    is_empty = false;
  });
  if (is_empty) {
    camera.world_from_camera.origin = turn.z * 3.0f;
    return camera;
  }
  double distance = std::max((right + left) / (2 * half.x), (top + bottom) / (2 * half.y));
  // A single point fills no picture; stand off from it all the same.
  if (!(distance > nearest)) distance = nearest + std::max(1.0, std::fabs(nearest) * 1e-3);
  camera.world_from_camera.origin = turn.x * static_cast<float>((right - left) / 2) +
                                    turn.y * static_cast<float>((top - bottom) / 2) +
                                    turn.z * static_cast<float>(distance);
  camera.focus_distance = static_cast<float>(distance - 0.5 * (nearest + farthest));
  return camera;
}

}  // namespace boxwood::render
