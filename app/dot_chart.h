// dot_chart.h: how do several figures of many things compare at a glance? A row for each thing, a dot for
// each figure, on one logarithmic axis (Cleveland, "The Elements of Graphing Data", 1985).
//
// Series come in pairs: the two of a pair share color and shape, the first hollow, the second filled. Colors
// as in chart.h.
#pragma once

#include <string>
#include <vector>

namespace boxwood::app {

struct DotRow {
  std::string name;
  std::vector<double> values;  ///< One for each series; 0 where there is none.
  std::string note;            ///< Behind the row.
};

/// Rows under one heading.
struct DotGroup {
  std::string name;
  std::vector<DotRow> rows;
};

/// All panels have the same groups and rows; the names stand to the left of the first.
struct DotPanel {
  std::string title;
  std::vector<DotGroup> groups;
};

struct DotChart {
  std::string title, subtitle, x_label, note;
  std::vector<std::string> series;
  std::vector<DotPanel> panels;
};

/// Draws the panels side by side. Returns the text of an SVG file.
std::string dot_chart(const DotChart& chart);

}  // namespace boxwood::app
