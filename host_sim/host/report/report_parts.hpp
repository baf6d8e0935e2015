#pragma once
// Pieces of report documents (host_sim/host/report/page/README.md) that scenarios share.

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace volcomp::host {

inline constexpr std::array<const char*, 6> kChannels{"EX", "EY", "EZ", "EA", "EB", "EC"};

[[nodiscard]] inline nlohmann::json axis_label(const char* label, const char* unit) {
  return {{"label", label}, {"unit", unit}};
}

[[nodiscard]] inline nlohmann::json series_of(const char* name, const std::vector<double>& x,
                                              const std::vector<double>& y) {
  return {{"name", name}, {"x", x}, {"y", y}};
}

[[nodiscard]] inline nlohmann::json column(const std::string& title, const char* unit, int digits) {
  return {{"title", title}, {"unit", unit}, {"digits", digits}};
}

}  // namespace volcomp::host
