#pragma once
// The patch of the paper and its searches against the closed flank of the same gear
// (docs/papers/face-gear.md, "The patch and the search of the paper"). The truth is the flank of
// comp/metrology/faces; nothing is simulated, nothing scatters.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/metrology/faces/face_grid.hpp"
#include "host_sim/experiments/face_gear/patch/closest_point.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/progress.hpp"

namespace volcomp::face_gear {

// Between two nodes the patch is evaluated in so many steps.
inline constexpr std::size_t kStepsOfACell = 10;
inline constexpr std::size_t kRasterRows = (kGridRows - 1) * kStepsOfACell + 1;
inline constexpr std::size_t kRasterColumns = (kGridColumns - 1) * kStepsOfACell + 1;

// Largest difference of a coordinate of the control points that Table 3 prints.
struct ControlDifference {
  const char* parameters = "";
  double largest_um = 0.0;
};

// How far the patch through the nodes of a flank is from that flank.
struct PatchDistance {
  bool relieved = false;
  double nodes_mm = 0.0;  // largest, in the nodes
  double largest_um = 0.0;
  double rms_um = 0.0;
  // kRasterRows · kRasterColumns, row by row, + outside the material.
  std::vector<double> raster_um = {};
};

// How far a search has come after one of its levels or steps, over all places.
struct SearchLevel {
  int points = 0;                   // of the patch, evaluated by then
  std::optional<double> step = {};  // of u or v; none: a start
  double largest_error_mm = 0.0;    // of the distance without its sign
};

struct PatchSearch {
  const char* key = "";
  const char* name = "";
  std::size_t levels = 0;          // most for a place
  std::optional<int> points = {};  // of the patch, most for a place; none: it takes no patch
  double largest_error_mm = 0.0;   // of the distance, over all places
  double nodes_mm = 0.0;           // largest distance from the nodes, which is none
  std::size_t unsettled = 0;       // places it finds nothing for; errors are those of the others
  std::optional<int> wrong_signs = {};   // none: the distance has no sign
  std::vector<SearchLevel> course = {};  // empty: one formula
};

// How the angle of the gear is found from one ball.
struct AngleSearch {
  const char* name = "";
  bool printed = false;                 // as the paper prints it
  std::optional<double> range_mm = {};  // l_max
  bool ends = false;
  int distances = 0;     // evaluated; all that were allowed where it does not end
  double rest_um = 0.0;  // distance less radius where it stands
};

struct PatchComparison {
  std::string gear_name;
  std::vector<host::HashedInput> inputs;
  FaceGear gear;
  bool table_3 = false;                    // the gear whose figures the paper prints
  std::vector<ControlDifference> control;  // of that gear only
  std::vector<PatchDistance> patch;        // without relief; with it, if the gear has one
  std::vector<PatchSearch> search;
  std::vector<AngleSearch> angle;
};

// `gear`: host::choose_face_gear. Throws UserError.
[[nodiscard]] PatchComparison compare_patch(const std::string& gear);

// One of the figures that the page promises.
struct PatchPromise {
  const char* key = "";
  std::string what;
  const char* unit = "";
  double found = 0.0;
  double limit = 0.0;
  bool at_least = false;  // else at most

  [[nodiscard]] bool holds() const { return at_least ? found >= limit : found <= limit; }
};
// Those of every gear, and for that of Table 3 the figures of the page.
[[nodiscard]] std::vector<PatchPromise> patch_promises(const PatchComparison& comparison);
// Good: all of them hold.
[[nodiscard]] host::Verdict patch_verdict(const PatchComparison& comparison);

}  // namespace volcomp::face_gear
