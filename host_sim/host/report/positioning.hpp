#pragma once
// Positioning of axes after ISO 230-2: plots with means and ±2 s of both directions, and the
// figures A, R, E, B, M as a table.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/metrology/tables/iso230.hpp"

namespace volcomp::host {

// One direction at every target; mm or rad.
struct DirectionRuns {
  std::vector<double> mean;
  std::vector<double> deviation;  // standard, n − 1
};

struct Positioning {
  char letter = '\0';
  bool rotary = false;
  std::string when;  // "before", "after"
  std::vector<double> at;
  DirectionRuns up;
  DirectionRuns down;
  Iso230Figures figures;
};

// Mean, standard deviation and figures of readings[run][target]. Throws UserError when they do not
// fit together.
[[nodiscard]] Positioning evaluate_positioning(char letter, bool rotary, std::string when,
                                               std::vector<double> at,
                                               const std::vector<std::vector<double>>& up,
                                               const std::vector<std::vector<double>>& down);

// All plots share their y range where the axes are of one kind.
[[nodiscard]] nlohmann::json positioning_group(const std::vector<Positioning>& axes,
                                               const std::string& note);
[[nodiscard]] nlohmann::json positioning_table(const std::vector<Positioning>& axes,
                                               const std::string& note);

}  // namespace volcomp::host
