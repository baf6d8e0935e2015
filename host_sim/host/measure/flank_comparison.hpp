#pragma once
// Compares two measurements of a face gear, for instance of the machine and of a gear measuring
// centre: their difference by rows and columns, and how much of it is due to their frames
// (docs/papers/face-gear.md, "How to reproduce").
//
// What the paper's tables leave open is an option here and is printed with every result.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/metrology/faces/map_comparison.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::host {

enum class Zeroing { as_given, centre, mean };

struct CompareOptions {
  std::vector<std::string> files;  // first and second map of the left flank, then of the right
  std::array<std::string, 2> names{"first", "second"};
  std::string gear = "table3";    // the gear (gear_choice.hpp); empty: frames are left out
  int left_side = 1;              // which side of the slot is called left
  bool plus_is_metal = true;      // the sign of the maps; results are + = excess material
  bool row_1_is_tip = true;       // else root
  bool column_1_is_inner = true;  // else outer
  double um_per_unit = 1.0;       // of the maps
  Zeroing zeroing = Zeroing::as_given;
  GridRange profile_rows = kProfileRows;
  std::optional<double> limit_um;  // of the largest difference: a verdict
};

struct MeasuredFlank {
  std::string file;
  ErrorMap map;
  CellStatistics statistics;
  std::optional<ProfileDeviation> profile;  // none: cells are missing
};

struct FlankPair {
  std::string name;  // "left" or "right"
  int side = 1;
  std::array<MeasuredFlank, 2> measured;
  MapDifference difference;  // first − second
};

// The profile of one measurement, both flanks.
struct GradedProfile {
  double value_um = 0.0;
  std::size_t flank = 0;
  std::size_t column = 0;
  std::optional<int> grade;  // none: worse than the last one known
};

struct FrameFinding {
  const char* what = nullptr;
  FrameShare share;
};

struct FlankComparison {
  CompareOptions options;
  std::vector<FlankPair> flanks;
  std::array<std::optional<GradedProfile>, 2> profile;  // by measurement; none: incomplete
  double largest_um = 0.0;
  double rms_um = 0.0;
  std::vector<FrameFinding> frame;  // empty without nominal points

  [[nodiscard]] bool within_limit() const {
    return !options.limit_um || largest_um <= *options.limit_um;
  }
};

// Throws UserError naming the file.
[[nodiscard]] FlankComparison compare_flanks(const CompareOptions& options);

// "+ = excess material; left is side +1; row 1 = tip; column 1 = inner": with every result.
[[nodiscard]] std::string conventions_of(const CompareOptions& options);
// Grade 5, or why there is none.
[[nodiscard]] std::string grade_text(const std::optional<GradedProfile>& profile);

// Rows of cells, µm; null: not measured.
[[nodiscard]] nlohmann::json cells_json(const ErrorMap& map);
[[nodiscard]] std::string comparison_text(const FlankComparison& comparison);
[[nodiscard]] nlohmann::json comparison_json(const FlankComparison& comparison);
// The document of a report.
[[nodiscard]] nlohmann::json comparison_document(const FlankComparison& comparison,
                                                 const RunContext& run);

}  // namespace volcomp::host
