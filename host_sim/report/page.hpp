#pragma once

#include <string>
#include <string_view>

namespace volcomp::sim {

// Where the page expects the report's JSON.
inline constexpr std::string_view report_data_mark = "@VOLCOMP_REPORT_DATA@";

// The report page without data; generated at build time by embed.mjs.
std::string report_page();

}  // namespace volcomp::sim
