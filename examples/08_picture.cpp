// 08_picture: how do rays become a picture?
// One through each pixel; the color of what it hits, and a ray to the sun.
#include <cstdio>

#include <boxwood/boxwood.h>
#include <boxwood/io/image.h>

using namespace boxwood;

int main(int argc, char** argv) {
  // Three balls on a floor, each of a color of its own.
  SceneDesc desc;
  const auto paint = [&desc](Vec3 color) { return desc.add(Material{.color = color}); };
  desc.add(std::vector<Sphere>{{{-2.2f, 1, 0}, 1}}, paint({0.9f, 0.3f, 0.2f}));
  desc.add(std::vector<Sphere>{{{0, 1, 0}, 1}}, paint({0.9f, 0.8f, 0.3f}));
  desc.add(std::vector<Sphere>{{{2.2f, 1, 0}, 1}}, paint({0.2f, 0.5f, 0.8f}));
  desc.add(std::vector<Quad>{{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}}, paint({0.7f, 0.7f, 0.7f}));
  const Scene scene(std::move(desc));

  const Affine3 world_from_camera = Affine3::look_at({0, 2.5f, 7}, {0, 0.8f, 0}, {0, 1, 0});
  const Vec3 to_sun = normalize({2, 3, 1});
  Image picture(480, 320);

  // Rows may be worked on at the same time, because a built scene is read-only.
  parallel_for(default_executor(), 0, 320, 8, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < 480; ++x) {
      // Shoot a ray through the middle of the pixel.
      const Vec3 in_camera{(x + 0.5f - 240) / 320, (160 - y - 0.5f) / 320, -1};
      const Ray ray{.origin = world_from_camera.origin, .direction = world_from_camera.vector(in_camera)};
      const Hit hit = scene.closest_hit(ray);

      // The sky, or the color of the thing, darker where the sun does not reach it.
      Vec3 color{0.55f, 0.75f, 0.95f};
      if (hit) {
        const Surface surface = surface_at(scene, ray, hit);
        const float slope = max(dot(surface.normal, to_sun), 0.0f);
        const bool is_lit = slope > 0 && !scene.any_hit(surface.spawn(to_sun));
        color = scene.description().materials[surface.material.value].color *
                (is_lit ? 0.2f + 0.8f * slope : 0.2f);
      }
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = color[c];
    }
  });

  io::write_image(argc > 1 ? argv[1] : "picture.png", picture);
  std::printf("wrote %d x %d pixels\n", picture.width, picture.height);
}
