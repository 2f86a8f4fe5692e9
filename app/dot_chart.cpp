#include "dot_chart.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "svg.h"

namespace boxwood::app {
namespace {

// The layout, in pixels.
constexpr double kNames = 176, kFrameWidth = 400, kNoteWidth = 84, kTop = 158, kBottom = 84;
constexpr double kRowHeight = 22, kHeadingHeight = 30, kLegendStep = 190;

struct Look {
  const char* color;
  char shape;  // o: circle, s: square, d: diamond
};
constexpr Look kLooks[] = {{"#0072B2", 'o'}, {"#D55E00", 's'}, {"#7F7F7F", 'd'}, {"#009E73", 'o'}};

/// Hollow for the first of a pair, filled for the second.
std::string dot(std::size_t series, double x, double y) {
  const Look& look = kLooks[series / 2 % std::size(kLooks)];
  const std::string paint = fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"",
                                        series % 2 ? look.color : "none", look.color);
  if (look.shape == 's')
    return fmt::format("<rect class=\"dot\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" {}/>\n", x - 4,
                       y - 4, paint);
  if (look.shape == 'd')
    return fmt::format("<path class=\"dot\" d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\" {}/>\n", x, y - 5, paint);
  return fmt::format("<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.6\" {}/>\n", x, y, paint);
}

std::string text(const char* kind, const char* anchor, double x, double y, const std::string& words) {
  return fmt::format("<text class=\"{}\" text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kind,
                     anchor, x, y, escaped(words));
}

std::string line(const char* kind, double x1, double y1, double x2, double y2) {
  return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", kind, x1, y1, x2, y2);
}

/// A logarithmic axis from 1, 2 or 5 times a power of ten to another.
class Axis {
 public:
  explicit Axis(const DotChart& chart) {
    double least = INFINITY, most = 0;
    for (const DotPanel& panel : chart.panels)
      for (const DotGroup& group : panel.groups)
        for (const DotRow& row : group.rows)
          for (const double value : row.values)
            if (value > 0) least = std::min(least, value), most = std::max(most, value);
    if (most == 0) least = most = 1;
    // From the last tick below all values to the first above them.
    for (int power = static_cast<int>(std::floor(std::log10(least))); ticks_.empty() || ticks_.back() <= most;
         ++power)
      for (const double digit : {1, 2, 5}) {
        const double tick = digit * std::pow(10.0, power);
        if (!ticks_.empty() && ticks_.back() > most) break;
        if (tick < least) ticks_.clear();
        ticks_.push_back(tick);
      }
  }
  const std::vector<double>& ticks() const { return ticks_; }
  /// 0 at the first tick, 1 at the last.
  double at(double value) const {
    return std::log(value / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
  }

 private:
  std::vector<double> ticks_;
};

double height_of(const DotPanel& panel) {
  double height = 0;
  for (const DotGroup& group : panel.groups)
    height += kHeadingHeight + kRowHeight * double(group.rows.size());
  return height;
}

void draw_panel(const DotPanel& panel, const Axis& axis, double left, bool has_names, std::string& svg) {
  const double bottom = kTop + height_of(panel) + 8;
  const auto x = [&](double value) { return left + kFrameWidth * axis.at(value); };
  svg += text("panel", "start", left, kTop - 12, panel.title);
  for (const double tick : axis.ticks()) {
    svg += line("major", x(tick), kTop, x(tick), bottom);
    svg += text("tick", "middle", x(tick), bottom + 18, fmt::format("{:g}", tick));
  }

  double y = kTop;
  for (const DotGroup& group : panel.groups) {
    y += kHeadingHeight;
    if (has_names) svg += text("name", "start", 24, y - 6, group.name);
    for (const DotRow& row : group.rows) {
      const double middle = y + kRowHeight / 2;
      y += kRowHeight;
      if (has_names) svg += text("tick", "end", left - 14, middle + 4.5, row.name);
      svg += line("minor", left, middle, left + kFrameWidth, middle);
      // Hollow dots above filled ones, so that both show; the first series above all.
      for (const std::size_t filled : {1, 0})
        for (std::size_t s = row.values.size(); s-- > 0;)
          if (s % 2 == filled && row.values[s] > 0) svg += dot(s, x(row.values[s]), middle);
      svg += text("label", "start", left + kFrameWidth + 14, middle + 4.5, row.note);
    }
  }
}

}  // namespace

std::string dot_chart(const DotChart& chart) {
  double height = 0;
  for (const DotPanel& panel : chart.panels) height = std::max(height, height_of(panel));
  const double panel_width = kFrameWidth + kNoteWidth;
  const double legend = 24 + kLegendStep * double(chart.series.size() / 2 + chart.series.size() % 2);
  const double width = std::max(kNames + panel_width * double(chart.panels.size()) + 12, legend);
  std::string svg = svg_begin(width, kTop + height + 8 + kBottom, chart.title, chart.subtitle);

  // The legend: a column for each pair.
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const double x = 30 + kLegendStep * double(s / 2), y = 86 + 19 * double(s % 2);
    svg += dot(s, x, y - 4.5) + text("label", "start", x + 12, y, chart.series[s]);
  }

  const Axis axis(chart);
  double left = kNames;
  for (const DotPanel& panel : chart.panels) {
    draw_panel(panel, axis, left, left == kNames, svg);
    svg += text("label", "middle", left + kFrameWidth / 2, kTop + height + 8 + 42, chart.x_label);
    left += panel_width;
  }
  if (!chart.note.empty()) svg += text("subtitle", "start", 24, kTop + height + 8 + 72, chart.note);
  return svg + "</svg>\n";
}

}  // namespace boxwood::app
