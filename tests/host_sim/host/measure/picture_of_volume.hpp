#pragma once
// The error vectors that a report draws.

#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/volume_csv.hpp"

namespace volcomp::host {

// Best-fit rigid motion taken out once, nothing is left to take out of any series.
inline void expect_aligned_picture(const nlohmann::json& document) {
  const auto& sections = document.at("sections");
  const auto chart = std::find_if(sections.begin(), sections.end(),
                                  [](const nlohmann::json& s) { return s.at("type") == "volume"; });
  ASSERT_NE(chart, sections.end());
  const auto vector_of = [](const nlohmann::json& v) {
    return Vec3(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
  };
  for (const nlohmann::json& series : chart->at("series")) {
    std::vector<VolumePoint> points;
    for (std::size_t i = 0; i < chart->at("points").size(); ++i) {
      const Vec3 error_mm = vector_of(series.at("vectors").at(i)) / kUmPerMm;
      points.push_back({vector_of(chart->at("points").at(i)), error_mm});
    }
    const std::vector<VolumePoint> again = aligned(points);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT((again[i].error_mm - points[i].error_mm).norm(), 1e-6) << series.at("name");
  }
}

}  // namespace volcomp::host
