#include <boxwood/boxwood.h>
#include <boxwood/io/image.h>

int main(int, char** argv) {
  boxwood::io::write_image(argv[1], boxwood::Image(4, 4));
  return boxwood::io::read_image(argv[1]).width == 4 ? 0 : 1;
}
