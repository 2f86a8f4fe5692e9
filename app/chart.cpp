#include "chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "numbers.h"
#include "svg.h"

namespace boxwood::app {
namespace {

// The layout, in pixels: each panel is its margins around its frame.
constexpr double kPanelWidth = 760, kFrameWidth = 430, kFrameHeight = 420;
constexpr double kLeft = 112, kTop = 116, kBottom = 64, kLabelHeight = 17;

struct Look {
  const char* color;
  char marker;                // o: circle, s: square, d: diamond, t: triangle
  const char* dash = "none";  // lets a curve of the same course shine through
};
constexpr Look kLooks[] = {{"#000000", 'o'}, {"#CC79A7", 's'},        {"#6F6F6F", 'd', "7 6"},
                           {"#D55E00", 't'}, {"#56B4E9", 'o'},        {"#0072B2", 's'},
                           {"#009E73", 'd'}, {"#E69F00", 't', "9 7"}, {"#7A3E9D", 'o', "2 7"},
                           {"#8C510A", 's'}, {"#1B4F4A", 'd'},        {"#B8336A", 't'}};

const Look& look_of(std::size_t series) {
  return kLooks[series % std::size(kLooks)];
}

std::string marker(const Look& look, double x, double y) {
  switch (look.marker) {
    case 's':
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"6.4\" height=\"6.4\"/>", x - 3.2, y - 3.2);
    case 'd':
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.4 4.4l-4.4 4.4l-4.4 -4.4z\"/>", x, y - 4.4);
    case 't':
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.2 7.2h-8.4z\"/>", x, y - 4.6);
    default:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>", x, y);
  }
}

/// 10 to the `power`, as a number or as a time.
std::string tick_name(int power, bool is_time) {
  if (!is_time)
    return power < 0 ? fmt::format("{:g}", std::pow(10.0, power)) : with_commas(std::pow(10.0, power));
  static const char* const kUnits[] = {"ns", "µs", "ms", "s"};
  const int unit = std::clamp(power / 3, 0, 3);
  return fmt::format("{:g} {}", std::pow(10.0, power - 3 * unit), kUnits[unit]);
}

/// An axis over whole powers of ten.
struct LogAxis {
  int first_power = 0, last_power = 1;
  double begin = 0, end = 1;  // in pixels

  void cover(double value) {
    first_power = std::min(first_power, static_cast<int>(std::floor(std::log10(value) + 1e-9)));
    last_power = std::max(last_power, static_cast<int>(std::ceil(std::log10(value) - 1e-9)));
  }
  double at(double value) const {
    return begin + (end - begin) * (std::log10(value) - first_power) / (last_power - first_power);
  }
};

LogAxis axis_over(const Panel& panel, double std::pair<double, double>::*coordinate) {
  LogAxis axis{1000, -1000};
  for (const Series& series : panel.series)
    for (const auto& point : series.points) axis.cover(point.*coordinate);
  if (axis.first_power > axis.last_power) axis = {0, 1};
  if (axis.first_power == axis.last_power) ++axis.last_power;
  return axis;
}

/// Moves labels apart: in order from the top,
/// none nearer to the one above than kLabelHeight, all inside the frame.
void spread(std::vector<std::pair<double, std::size_t>>& labels, double top, double bottom) {
  std::sort(labels.begin(), labels.end());
  for (double free = top; auto& [y, series] : labels) {
    y = std::max(y, free);
    free = y + kLabelHeight;
  }
  double free = bottom;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->first = std::min(label->first, free);
    free = label->first - kLabelHeight;
  }
}

void draw_panel(const Panel& panel, double left, std::string& svg) {
  const double right = left + kFrameWidth, top = kTop, bottom = kTop + kFrameHeight;
  LogAxis x = axis_over(panel, &std::pair<double, double>::first);
  LogAxis y = axis_over(panel, &std::pair<double, double>::second);
  x.begin = left, x.end = right;
  y.begin = bottom, y.end = top;

  // Lines at the powers of ten, fainter ones between.
  svg += fmt::format("<text class=\"panel\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, top - 16,
                     escaped(panel.title));
  const auto line = [&](const char* kind, double x1, double y1, double x2, double y2) {
    svg += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", kind, x1, y1, x2, y2);
  };
  for (int power = x.first_power; power <= x.last_power; ++power) {
    const double at = x.at(std::pow(10.0, power));
    line("major", at, top, at, bottom);
    svg += fmt::format("<text class=\"tick\" text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                       at, bottom + 19, tick_name(power, false));
    for (int digit = 2; digit < 10 && power < x.last_power; ++digit) {
      const double between = x.at(digit * std::pow(10.0, power));
      line("minor", between, top, between, bottom);
    }
  }
  for (int power = y.first_power; power <= y.last_power; ++power) {
    const double at = y.at(std::pow(10.0, power));
    line("major", left, at, right, at);
    svg += fmt::format("<text class=\"tick\" text-anchor=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                       left - 8, at + 4, tick_name(power, panel.is_time));
  }
  svg += fmt::format("<text class=\"label\" text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                     (left + right) / 2, bottom + 44, escaped(panel.x_label));
  svg += fmt::format(
      "<text class=\"label\" text-anchor=\"middle\" transform=\"translate({:.1f} "
      "{:.1f})rotate(-90)\">{}</text>\n",
      left - 88, (top + bottom) / 2, escaped(panel.y_label));

  // The curves, and where each ends.
  std::vector<std::pair<double, std::size_t>> labels;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const Series& series = panel.series[s];
    if (series.points.empty()) continue;
    const Look& look = look_of(s);
    std::string path, marks;
    for (const auto& point : series.points) {
      const double px = x.at(point.first), py = y.at(point.second);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
      marks += marker(look, px, py);
    }
    svg += fmt::format(
        "<path class=\"curve\" stroke=\"{}\" stroke-dasharray=\"{}\" d=\"{}\"/>\n<g fill=\"{}\">{}</g>\n",
        look.color, look.dash, path, look.color, marks);
    labels.emplace_back(y.at(series.points.back().second), s);
  }

  // Its name beside the end, tied to it by a thin line.
  spread(labels, top + 4, bottom - 4);
  for (const auto& [at, s] : labels) {
    const Series& series = panel.series[s];
    const double end_x = x.at(series.points.back().first), end_y = y.at(series.points.back().second);
    svg +=
        fmt::format("<path class=\"tie\" stroke=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n",
                    look_of(s).color, end_x + 5, end_y, right + 14, at, right + 20, at);
    svg += fmt::format(
        "<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}<tspan class=\"note\" "
        "dx=\"9\">N</tspan>"
        "<tspan class=\"note\" dy=\"-5\" font-size=\"10.5\">{:.2f}</tspan></text>\n",
        right + 24, at + 4.5, look_of(s).color, escaped(series.name), series.exponent);
  }
}

}  // namespace

std::string log_log_chart(const std::string& title, const std::string& subtitle,
                          const std::vector<Panel>& panels) {
  const double width = kPanelWidth * double(panels.size()), height = kTop + kFrameHeight + kBottom;
  std::string svg = svg_begin(width, height, title, subtitle);
  for (std::size_t p = 0; p < panels.size(); ++p) draw_panel(panels[p], kPanelWidth * double(p) + kLeft, svg);
  return svg + "</svg>\n";
}

}  // namespace boxwood::app
