// 07_own_query: how does one ask a question that nobody thought of? With a bound, a limit and a visit.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

// Which ball reaches highest above a point of the ground?
// The bound and the limit turn "highest" into "smallest".
class HighestAbove {
 public:
  HighestAbove(float x, float z, const std::vector<Sphere>& balls) : x_(x), z_(z), balls_(balls) {}

  // Nothing inside the box is better than its top. The law: at most the bound of any box inside it.
  float bound(const Box3& box) const {
    const bool is_below = box.lower.x <= x_ && x_ <= box.upper.x && box.lower.z <= z_ && z_ <= box.upper.z;
    return is_below ? -box.upper.y : kInfinity;
  }
  // What does not reach higher than the best so far no longer matters. The law: never grows.
  float limit() const { return -height_; }
  // Look at one ball.
  void visit(PrimId id) {
    const Sphere& ball = balls_[id.value];
    const float dx = x_ - ball.center.x, dz = z_ - ball.center.z,
                rest = ball.radius * ball.radius - dx * dx - dz * dz;
    if (rest < 0) return;
    ++visits;
    height_ = max(height_, ball.center.y + std::sqrt(rest));
  }
  float height() const { return height_; }
  int visits = 0;

 private:
  float x_, z_;
  const std::vector<Sphere>& balls_;
  float height_ = -kInfinity;
};
static_assert(Query<HighestAbove>);

int main() {
  Random random(1);
  std::vector<Sphere> balls;
  for (int i = 0; i < 100000; ++i)
    balls.push_back({random.in_box({0, 0, 0}, {100, 10, 100}), random.uniform(0.1f, 1)});

  const Bvh bvh = build(boxes(balls));
  HighestAbove query(50, 50, balls);
  traverse(bvh, query);
  std::printf("the highest point above (50, 50) is at %.3f\n", query.height());
  std::printf("found by looking at fewer than 20 of %zu balls: %s\n", balls.size(),
              query.visits < 20 ? "yes" : "no");
}
