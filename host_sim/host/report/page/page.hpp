#pragma once

#include <string>
#include <string_view>

namespace volcomp::host {

// Where the page expects the report's JSON.
inline constexpr std::string_view report_data_mark = "@VOLCOMP_REPORT_DATA@";

// The report page without data, and the live page with its script and style; generated at build
// time by embed.mjs; empty without node's packages (no_page.cpp).
std::string report_page();
std::string live_page();
std::string live_script();
std::string live_style();

}  // namespace volcomp::host
