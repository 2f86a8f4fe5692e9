#include "svg.h"

#include <fmt/format.h>

namespace boxwood::app {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  }
  return out;
}

std::string svg_begin(double width, double height, const std::string& title, const std::string& subtitle) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" "
      "font-family=\"DejaVu Sans, Verdana, Helvetica, Arial, sans-serif\">\n"
      "<style>\n"
      ".title{{font-size:22px;font-weight:bold;fill:#222}}\n"
      ".subtitle{{font-size:14px;fill:#555}}\n"
      ".panel{{font-size:16px;font-weight:bold;fill:#222}}\n"
      ".label,.tick{{font-size:13px;fill:#444}}\n"
      ".name{{font-size:13px;font-weight:bold}}\n"
      ".note{{font-weight:normal;fill:#555}}\n"
      ".major{{stroke:#cccccc;stroke-width:1;fill:none}}\n"
      ".minor{{stroke:#ececec;stroke-width:1;fill:none}}\n"
      ".curve{{stroke-width:2.2;fill:none;stroke-linejoin:round}}\n"
      ".tie{{stroke-width:1;stroke-opacity:0.45;fill:none}}\n"
      "</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text class=\"title\" x=\"24\" y=\"38\">{2}</text>\n"
      "<text class=\"subtitle\" x=\"24\" y=\"62\">{3}</text>\n",
      width, height, escaped(title), escaped(subtitle));
}

}  // namespace boxwood::app
