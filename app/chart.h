// chart.h: how does a power law look? A straight line: panels with logarithmic axes, as one SVG picture.
//
// Colors are told apart by color-blind eyes (Okabe and Ito, "Color Universal Design", 2008), and by their
// markers too; every line carries its name at its end.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace boxwood::app {

struct Series {
  std::string name;
  double exponent = 0;                            ///< Of the power of x that fits; stands behind the name.
  std::vector<std::pair<double, double>> points;  ///< All above 0; x ascending.
};

struct Panel {
  std::string title, x_label, y_label;
  bool is_time = false;        ///< y is in nanoseconds, and is labelled in ns, µs, ms or s.
  std::vector<Series> series;  ///< The k-th series of every panel has the same color.
};

/// Draws the panels side by side. Returns the text of an SVG file.
std::string log_log_chart(const std::string& title, const std::string& subtitle,
                          const std::vector<Panel>& panels);

}  // namespace boxwood::app
