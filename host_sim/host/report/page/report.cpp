#include "host_sim/host/report/page/report.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "host_sim/host/report/page/page.hpp"

namespace volcomp::host {
namespace {

// "</script" or "<!--" inside a text would end or derail the script element that
// holds the data. In JSON a "<" can only be part of a string, where \u003c means the same.
std::string escape_for_html(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size() + json.size() / 64);
  for (const char character : json) {
    if (character == '<') {
      escaped += "\\u003c";
    } else {
      escaped += character;
    }
  }
  return escaped;
}

std::string page_with(std::string_view json) {
  std::string page = report_page();
  const auto mark = page.find(report_data_mark);
  if (mark == std::string::npos)
    throw std::logic_error("the report page has no place for its data");
  return page.replace(mark, report_data_mark.size(), escape_for_html(json));
}

}  // namespace

bool has_report_page() { return !report_page().empty(); }

// A name that is not UTF-8, for instance of a file, must not lose the whole report.
std::string report_text(const nlohmann::json& document) {
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

std::string report_html(const nlohmann::json& document) { return page_with(report_text(document)); }

}  // namespace volcomp::host
