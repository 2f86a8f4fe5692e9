// A project that uses the installed core library and both wings.
#include <boxwood/io/image.h>
#include <boxwood/render/render.h>

int main(int, char** argv) {
  boxwood::SceneDesc desc;
  desc.add(std::vector<boxwood::Sphere>{{{0, 0, 0}, 1}});
  const boxwood::Scene scene(std::move(desc));
  boxwood::io::write_image(
      argv[1], boxwood::render::render_picture(scene, {.width = 32, .height = 24, .samples = 1}).image);
  return boxwood::io::read_image(argv[1]).width == 32 ? 0 : 1;
}
