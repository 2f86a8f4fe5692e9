// The fast search for the nearest of sixteen neighbours against the obvious one.
#include "boxwood/build/nearest.h"

#include <gtest/gtest.h>

#include "support/box_sets.h"

namespace boxwood {
namespace {

using test::box_sets;
using test::BoxSet;

struct Row {
  explicit Row(const std::vector<Box3>& boxes) {
    for (int k = 0; k < 6; ++k) {
      planes[k].assign(boxes.size() + 3 * kReach, 3e38f);
      row.plane[k] = planes[k].data() + kReach;
      for (std::size_t i = 0; i < boxes.size(); ++i)
        row.plane[k][i] = k < 3 ? -boxes[i].lower[k] : boxes[i].upper[k - 3];
    }
    row.count = static_cast<std::uint32_t>(boxes.size());
  }
  std::vector<float> planes[6];
  BoxRow row;
};

TEST(Nearest, IsTheSmallestUnionButForRounding) {
  for (const BoxSet& set : box_sets()) {
    std::vector<Box3> boxes;
    Box3 all;
    for (const Box3& box : set.boxes)
      if (!box.is_empty() && boxes.size() < 1000) boxes.push_back(box), all.extend(box);
    if (boxes.size() < 2) continue;
    const Row row(boxes);
    const auto extent = [](const Box3& b) { return max_component(b.upper * 0.5f - b.lower * 0.5f); };
    if (extent(all) > 1e38f || extent(all) < 1e-36f) continue;  // sizes beyond floats are all the same

    const Item item(all, PrimId(0));
    std::vector<std::uint16_t> partner(boxes.size());
    find_nearest(row.row, Scale(item.reach()), partner.data());
    const double size_of_all = double(extent(all)) * extent(all);
    for (int i = 0; i < int(boxes.size()); ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (int j = std::max(0, i - kReach); j <= std::min(int(boxes.size()) - 1, i + kReach); ++j)
        if (j != i) least = std::min(least, half_area(unite(boxes[i], boxes[j])));
      ASSERT_LT(partner[i], boxes.size()) << set.name;
      ASSERT_NE(partner[i], i) << set.name;
      ASSERT_LE(std::abs(partner[i] - i), kReach) << set.name;
      EXPECT_LE(half_area(unite(boxes[i], boxes[partner[i]])), least * (1 + 1e-5) + 1e-4 * size_of_all)
          << set.name << ", box " << i;
    }
  }
}

TEST(Nearest, SomeChooseEachOther) {
  for (const BoxSet& set : box_sets()) {
    std::vector<Box3> boxes;
    Reach all;
    for (const Box3& box : set.boxes)
      if (!box.is_empty() && boxes.size() < 1000) {
        boxes.push_back(box);
        all.extend(Item(box, PrimId(0)).reach());
      }
    if (boxes.size() < 2) continue;
    const Row row(boxes);
    std::vector<std::uint16_t> partner(boxes.size());
    find_nearest(row.row, Scale(all), partner.data());
    int mutual = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ASSERT_LT(partner[i], boxes.size()) << set.name;
      mutual += partner[partner[i]] == i;
    }
    EXPECT_GE(mutual, 2) << set.name;
    if (set.name == "coincident") {
      EXPECT_EQ(mutual, int(boxes.size()));
    }
  }
}

}  // namespace
}  // namespace boxwood
