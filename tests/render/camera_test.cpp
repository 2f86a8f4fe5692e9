// The lens, and the camera that frames a scene that has none.
#include "boxwood/render/camera.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood::render {
namespace {

/// Where the camera sees `p`, in units of the picture's half sides; z is the distance along the view.
Vec3 project(const Camera& camera, int width, int height, Vec3 p) {
  const Vec3 local = inverse(camera.world_from_camera).point(p);
  const float half = std::tan(camera.fov_deg * 0.5f * 3.14159265f / 180);
  const float shorter = static_cast<float>(std::min(width, height));
  return {local.x / -local.z / (half * static_cast<float>(width) / shorter),
          local.y / -local.z / (half * static_cast<float>(height) / shorter), -local.z};
}

SceneDesc random_points(std::uint64_t seed, Vec3 size, Vec3 center) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 100; ++i) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.direction() * size);
    mesh.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  SceneDesc desc;
  desc.add(std::move(mesh));
  return desc;
}

TEST(Lens, ParallelRaysSpanTheirSizeOfTheWorld) {
  Camera camera;
  camera.world_from_camera = Affine3::look_at({3, 4, 5}, {0, 4, 5}, {0, 1, 0});  // along -x, right is -z
  camera.orthographic_size = 2;
  camera.lens_radius = 1;  // has no meaning then
  const Lens lens(camera, 200, 100);
  const Ray corner = lens.ray({0, 0}, {0.9f, 0.2f}), middle = lens.ray({100, 50}, {0.1f, 0.3f});
  EXPECT_LT(length(middle.origin - Vec3{3, 4, 5}), 1e-6f);
  EXPECT_LT(length(corner.origin - Vec3{3, 5, 7}), 1e-6f);
  EXPECT_LT(length(middle.direction - Vec3{-1, 0, 0}), 1e-6f);
  EXPECT_EQ(corner.direction, middle.direction);
  EXPECT_EQ(pixel_angle(camera, 200, 100), 0);

  camera.orthographic_size = -1;
  EXPECT_THROW(Lens(camera, 200, 100), std::invalid_argument);
}

TEST(Camera, FramesEverythingAndFillsThePicture) {
  const Vec3 sizes[] = {{1, 1, 1}, {100, 0.01f, 3}, {0.001f, 0.002f, 0.0001f}, {1e4f, 1e4f, 10}, {0, 1, 0}};
  for (const Vec3 size : sizes) {
    for (const auto& [width, height] : {std::pair{1280, 720}, {300, 900}, {64, 64}}) {
      const SceneDesc desc = random_points(3, size, size * 5.0f);
      const Camera camera = frame_camera(desc, width, height);
      float reach = 0;
      for (const Vec3 p : std::get<TriangleMesh>(desc.geometries[0].shapes).positions) {
        const Vec3 q = project(camera, width, height, p);
        ASSERT_GT(q.z, 0);
        EXPECT_LE(std::fabs(q.x), 1);
        EXPECT_LE(std::fabs(q.y), 1);
        reach = std::max({reach, std::fabs(q.x), std::fabs(q.y)});
      }
      // Some side is nearly touched: the picture is filled.
      EXPECT_GT(reach, 0.85f) << size.x << " " << width << "x" << height;
      EXPECT_LT(reach, 0.95f) << size.x << " " << width << "x" << height;
    }
  }
}

TEST(Camera, FramesInstancesAndOtherShapes) {
  SceneDesc desc;
  const GeometryId ball = desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}});
  desc.add(Instance{ball, Affine3::translation({50, 0, 0}), {}});
  desc.add(Instance{ball, Affine3::translation({-50, 20, 0}) * Affine3::scale(4), {}});
  const Camera camera = frame_camera(desc, 400, 300);
  for (const Vec3 p : {Vec3{50, 0, 0}, {-50, 20, 0}, {-53, 20, 0}, {-50, 23, 0}}) {
    const Vec3 q = project(camera, 400, 300, p);
    EXPECT_TRUE(q.z > 0 && std::fabs(q.x) < 1 && std::fabs(q.y) < 1);
  }
}

TEST(Camera, FramesNothingAndASinglePointToo) {
  SceneDesc nothing;
  EXPECT_NO_THROW(Lens(frame_camera(nothing, 10, 10), 10, 10));
  SceneDesc point;
  point.add(TriangleMesh{{{7, 8, 9}, {7, 8, 9}, {7, 8, 9}}, {{0, 1, 2}}, {}, {}});
  const Camera camera = frame_camera(point, 10, 10);
  const Vec3 q = project(camera, 10, 10, {7, 8, 9});
  EXPECT_GT(q.z, 0);
  EXPECT_LT(std::fabs(q.x) + std::fabs(q.y), 0.01f);
}

TEST(Camera, TheOwnOneOfTheSceneWins) {
  SceneDesc desc = random_points(1, {1, 1, 1}, {});
  desc.camera = Camera{};
  desc.camera->fov_deg = 77;
  EXPECT_EQ(choose_camera(desc, 10, 10).fov_deg, 77);
}

TEST(Lens, CornersOfTheFilm) {
  Camera camera;
  camera.fov_deg = 90;
  const Lens lens(camera, 200, 100);
  // The angle spans the shorter side: half of it is 1 at distance 1, and the longer one is twice as long.
  const auto direction = [&](float x, float y) {
    const Vec3 d = lens.ray({x, y}, {}).direction;
    return d / -d.z;
  };
  EXPECT_NEAR(length(direction(100, 50) - Vec3{0, 0, -1}), 0, 1e-6f);
  EXPECT_NEAR(length(direction(0, 0) - Vec3{-2, 1, -1}), 0, 1e-5f);      // upper left
  EXPECT_NEAR(length(direction(200, 100) - Vec3{2, -1, -1}), 0, 1e-5f);  // lower right
  EXPECT_NEAR(length(lens.ray({13, 7}, {}).direction), 1, 1e-6f);
}

TEST(Lens, AllRaysOfAPointMeetInThePlaneOfFocus) {
  Camera camera;
  camera.world_from_camera = Affine3::look_at({3, 4, 5}, {0, 1, 0}, {0, 1, 0});
  camera.lens_radius = 0.3f;
  camera.focus_distance = 6;
  const Lens lens(camera, 100, 100);
  camera.lens_radius = 0;
  const Lens pinhole(camera, 100, 100);

  const Ray middle = pinhole.ray({20, 70}, {});
  const Vec3 forward = -camera.world_from_camera.z;
  const Vec3 in_focus = middle.at(6 / dot(middle.direction, forward));
  Random random(1);
  float farthest = 0;
  for (int i = 0; i < 100; ++i) {
    const Ray ray = lens.ray({20, 70}, {random.uniform(), random.uniform()});
    const float t = 6 / dot(ray.direction, forward);
    EXPECT_LT(length(ray.at(t) - in_focus), 1e-5f);
    const float from_middle = length(ray.origin - middle.origin);
    EXPECT_LE(from_middle, 0.3001f);
    farthest = std::max(farthest, from_middle);
  }
  EXPECT_GT(farthest, 0.25f);
}

TEST(Lens, RefusesWhatIsNoCamera) {
  Camera camera;
  camera.fov_deg = 180;
  EXPECT_THROW(Lens(camera, 10, 10), std::invalid_argument);
  camera.fov_deg = std::nanf("");
  EXPECT_THROW(Lens(camera, 10, 10), std::invalid_argument);
  camera.fov_deg = 40;
  camera.world_from_camera.x = {0, 0, 0};
  EXPECT_THROW(Lens(camera, 10, 10), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood::render
