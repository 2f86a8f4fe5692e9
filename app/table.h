// table.h: how do numbers stand below each other on a terminal?
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::app {

/// Columns as wide as their widest cell; the first to the left, the others to the right.
class Table {
 public:
  /// The first row names the columns; a line is drawn below it.
  explicit Table(std::vector<std::string> head) { add(std::move(head)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  std::string text() const {
    std::vector<std::size_t> widths(rows_[0].size(), 0);
    for (const auto& row : rows_)
      for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], glyphs(row[c]));
    std::string out;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      std::string line = "  ";
      for (std::size_t c = 0; c < rows_[r].size(); ++c) {
        const std::string blank(widths[c] - glyphs(rows_[r][c]), ' ');
        line += c == 0 ? rows_[r][c] + blank : "   " + blank + rows_[r][c];
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + "\n";
      if (r > 0) continue;
      std::size_t length = 0;
      for (const std::size_t width : widths) length += width + 3;
      for (out += "  "; length > 3; --length) out += "─";
      out += "\n";
    }
    return out;
  }

 private:
  /// Places on the terminal: bytes of UTF-8 that begin a character.
  static std::size_t glyphs(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  }

  std::vector<std::vector<std::string>> rows_;
};

}  // namespace boxwood::app
