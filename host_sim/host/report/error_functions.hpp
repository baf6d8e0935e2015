#pragma once
// Error functions of axes as curves with bands: displacements and angles of each axis.

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/machine/error_motion.hpp"

namespace volcomp::host {

struct ErrorCurves {
  char letter = '\0';
  bool rotary = false;
  std::vector<double> at;                                         // mm or rad
  std::vector<ErrorMotion> value;                                 // mm and rad
  std::vector<ErrorMotion> half_width;                            // of the bands; empty: none
  std::array<bool, 6> known{true, true, true, true, true, true};  // channels that are drawn
};

// A group of two charts for each axis; none of displacements or angles of which no channel is
// known.
[[nodiscard]] nlohmann::json error_functions_group(const std::string& title,
                                                   const std::vector<ErrorCurves>& axes,
                                                   const std::string& note);

}  // namespace volcomp::host
