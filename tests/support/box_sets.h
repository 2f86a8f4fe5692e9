// box_sets.h: which boxes should a tree survive?
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "boxwood/core/box.h"
#include "boxwood/core/random.h"

namespace boxwood::test {

struct BoxSet {
  std::string name;
  std::vector<Box3> boxes;
};

/// Boxes of random triangles: corners within `size` of a
/// random point of the unit cube, sizes from tiny to large.
inline std::vector<Box3> soup_boxes(std::size_t count, std::uint64_t seed = 1, float largest = 0.05f) {
  Random random(seed);
  std::vector<Box3> boxes(count);
  for (Box3& box : boxes) {
    const Vec3 center = random.in_box({0, 0, 0}, {1, 1, 1});
    const float s = random.uniform();
    const float size = largest * s * s * s * s;
    for (int corner = 0; corner < 3; ++corner) box.extend(center + random.in_box(splat(-size), splat(size)));
  }
  return boxes;
}

/// Boxes of the triangles of a rolling height field of n by n cells.
inline std::vector<Box3> terrain_boxes(int n) {
  const auto at = [n](int i, int j) {
    const float x = float(i) / float(n), y = float(j) / float(n);
    return Vec3{x, y, 0.1f * std::sin(9 * x) * std::cos(7 * y) + 0.02f * std::sin(50 * x + 30 * y)};
  };
  std::vector<Box3> boxes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int half = 0; half < 2; ++half) {
        Box3 box;
        box.extend(at(i, j + half));
        box.extend(at(i + 1, j));
        box.extend(at(i + half, j + 1));
        boxes.push_back(box);
      }
  return boxes;
}

/// The boxes of the sets below in order:
/// nothing, one, two, coincident, flat, huge, tiny, mixed and deep ones.
inline std::vector<BoxSet> box_sets() {
  std::vector<BoxSet> sets;
  sets.push_back({"nothing", {}});
  sets.push_back({"one", {{{1, 2, 3}, {4, 5, 6}}}});
  sets.push_back({"two", {{{0, 0, 0}, {1, 1, 1}}, {{5, 5, 5}, {6, 6, 6}}}});
  sets.push_back({"coincident", std::vector<Box3>(1000, Box3{{1, 1, 1}, {2, 3, 4}})});
  sets.push_back({"coincident points", std::vector<Box3>(1000, Box3{{7, 7, 7}, {7, 7, 7}})});
  sets.push_back({"soup", soup_boxes(5000)});
  sets.push_back({"terrain", terrain_boxes(40)});

  Random random(5);
  const auto scaled = [](std::vector<Box3> boxes, Vec3 by, Vec3 shift) {
    for (Box3& box : boxes) box = {box.lower * by + shift, box.upper * by + shift};
    return boxes;
  };
  sets.push_back({"flat", scaled(soup_boxes(2000, 2), {1, 1, 0}, {0, 0, 3})});
  sets.push_back({"on a line", scaled(soup_boxes(2000, 3), {0, 1, 0}, {2, 0, 3})});
  sets.push_back({"huge", scaled(soup_boxes(2000, 4), splat(2e30f), splat(-1e30f))});
  sets.push_back({"as huge as floats get", scaled(soup_boxes(2000, 4), splat(3e38f), splat(-1.5e38f))});
  sets.push_back({"tiny", scaled(soup_boxes(2000, 5), splat(1e-30f), splat(0))});
  sets.push_back({"smaller than normal floats", scaled(soup_boxes(2000, 6), splat(1e-39f), splat(0))});
  sets.push_back({"far away", scaled(soup_boxes(2000, 7), splat(1), splat(1e6f))});

  BoxSet grid{"grid", {}};
  for (int i = 0; i < 4096; ++i) {
    const Vec3 corner{float(i % 16), float(i / 16 % 16), float(i / 256)};
    grid.boxes.push_back({corner, corner + splat(1)});
  }
  sets.push_back(grid);

  // Each is as large as all before it together: halving space takes off one at a time.
  BoxSet progression{"geometric progression", {}}, fan{"progression of many", {}};
  for (int i = -120; i < 120; ++i) {
    const float x = std::ldexp(1.0f, i);
    progression.boxes.push_back({{x, 0, 0}, {1.5f * x, x, x}});
    for (int k = 0; k < 20; ++k) fan.boxes.push_back({{x, 0, 0}, {1.25f * x, 0, x}});
  }
  sets.push_back(progression);
  sets.push_back(fan);

  BoxSet some_empty{"empty boxes among others", soup_boxes(3000, 8)}, one_full{"all empty but one", {}};
  for (std::size_t i = 0; i < some_empty.boxes.size(); i += 3) some_empty.boxes[i] = Box3{};
  one_full.boxes.assign(500, Box3{});
  one_full.boxes[77] = {{1, 1, 1}, {2, 2, 2}};
  sets.push_back(some_empty);
  sets.push_back(one_full);
  sets.push_back({"one empty", {Box3{}}});
  sets.push_back({"all empty", std::vector<Box3>(300, Box3{})});

  BoxSet zeros{"zeros of both signs", {}};
  for (int i = 0; i < 600; ++i) {
    const float zero = i % 2 ? 0.0f : -0.0f;
    zeros.boxes.push_back({{zero, float(i % 7), -float(i % 5)}, {zero, float(i % 7) + 1, zero}});
  }
  sets.push_back(zeros);

  BoxSet mixed{"huge and tiny together", {}};
  for (int i = 0; i < 2000; ++i) {
    const float size = std::ldexp(1.0f, int(random.below(200)) - 100);
    const Vec3 corner = random.in_box(splat(-size), splat(size));
    mixed.boxes.push_back({corner, corner + splat(size * random.uniform())});
  }
  sets.push_back(mixed);
  return sets;
}

}  // namespace boxwood::test
