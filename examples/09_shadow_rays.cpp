// 09_shadow_rays: a million rays, and who does the work?
// Spans in, spans out, on threads that the caller chooses.
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

// Threads of one's own: the library asks this object to run its loops, and never starts a thread by itself.
class TwoThreads final : public Executor {
 public:
  int concurrency() const override { return 2; }
  void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) override {
    const std::size_t middle = begin + (end - begin) / 2;
    both([&] { serial_executor().for_range(begin, middle, grain, body); },
         [&] { serial_executor().for_range(middle, end, grain, body); });
  }
  void both(const Task& first, const Task& second) override {
    std::thread other(second);  // a real one would carry an exception of `second` over
    first();
    other.join();
  }
};

int main() {
  // A tower on a square, and the sun at 45 degrees.
  SceneDesc desc;
  desc.add(std::vector<Cuboid>{{{-1, 0, -1}, {1, 10, 1}}});
  const Scene scene(std::move(desc));
  const Vec3 to_sun{1, 1, 0};

  // One shadow ray from each point of a grid on the ground, 20 by 20 units.
  const int n = 1000;
  std::vector<Ray> rays;
  for (int i = 0; i < n * n; ++i) {
    const float x = (static_cast<float>(i % n) + 0.5f) * 20 / n - 21,
                z = (static_cast<float>(i / n) + 0.5f) * 20 / n - 10;
    rays.push_back({.origin = {x, 0, z}, .direction = to_sun});
  }
  const auto in_shadow = std::make_unique<bool[]>(rays.size());
  TwoThreads mine;
  scene.any_hit(rays, {in_shadow.get(), rays.size()}, &mine);

  // The shadow is 2 wide; on this side of the tower it is as long as the tower is high.
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) count += in_shadow[i];
  std::printf("%zu points of %zu lie in the shadow: an area of %.2f\n", count, rays.size(),
              400.0 * count / rays.size());
}
