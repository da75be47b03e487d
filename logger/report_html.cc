#include "logger/report_html.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "base/html.h"

namespace terra::logger {

std::string Escape(std::string_view text) {
  std::string printable(text);
  for (char& c : printable) {
    if (c == '\n') c = ' ';
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return EscapeHtml(printable);
}

std::string Format(const char* format, ...) {
  std::array<char, 512> text{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

std::string Number(double value, int decimals) {
  return std::isfinite(value) ? Format("%.*f", decimals, value) : "-";
}

std::string Duration(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  if (seconds < 1e-3) return Format("%.0f &micro;s", 1e6 * seconds);
  if (seconds < 1.0) return Format("%.2f ms", 1e3 * seconds);
  return Format("%.2f s", seconds);
}

std::string Key(
    const std::vector<std::pair<std::string, std::string>>& colors) {
  std::string html = "<div class=\"key\">";
  for (const auto& [color, name] : colors) {
    html +=
        "<span><i style=\"background:" + color + "\"></i>" + name + "</span>";
  }
  return html + "</div>\n";
}

std::string Table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& head : heads) html += "<th>" + head + "</th>";
  html += "</tr></thead><tbody>";
  for (const auto& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + cell + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace terra::logger
