#pragma once
// Sections that are charts (page/README.md, "Document"), and what their curves are made of.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/core/units.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {

inline constexpr double kUradPerRad = 1e6;
inline constexpr double kDegPerRad = 180.0 / kPi;

// Curves: `series` is an array of series_of() and its like.
[[nodiscard]] nlohmann::json lines_chart(const std::string& id, const std::string& title,
                                         nlohmann::json x, nlohmann::json y, nlohmann::json series,
                                         const std::string& note = "");
// A bar of each series for each category.
[[nodiscard]] nlohmann::json bar_chart(const std::string& id, const std::string& title,
                                       const std::vector<double>& categories, nlohmann::json y,
                                       nlohmann::json series, const std::string& note = "");
[[nodiscard]] nlohmann::json bar_chart(const std::string& id, const std::string& title,
                                       const std::vector<std::string>& categories, nlohmann::json y,
                                       nlohmann::json series, const std::string& note = "");
// Charts side by side under one legend; `shared_y`: with the same y range.
[[nodiscard]] nlohmann::json chart_group(const std::string& id, const std::string& title,
                                         nlohmann::json charts, const std::string& note,
                                         bool shared_y = true);
// A table, text or chart with its place for links, and a note below it.
[[nodiscard]] nlohmann::json with_id(const std::string& id, nlohmann::json section,
                                     const std::string& note = "");

// A series of single points, and one of bars.
[[nodiscard]] nlohmann::json points_of(const char* name, const std::vector<double>& x,
                                       const std::vector<double>& y);
[[nodiscard]] nlohmann::json bars_of(const char* name, const std::vector<double>& values);

// 1, 2, … n
[[nodiscard]] std::vector<double> counted(std::size_t n);
[[nodiscard]] std::vector<double> scaled(std::vector<double> values, double factor);

}  // namespace volcomp::host
