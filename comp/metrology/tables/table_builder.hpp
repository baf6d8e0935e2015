#pragma once
// From raw measured runs to the error table of one axis (docs/papers/xyfz.md, "What we do"), in
// this order: validate, average per direction, refer to the reference knot, remove the straightness
// slope, transfer to the reading head, re-zero.

#include <array>
#include <optional>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/metrology/tables/abbe.hpp"
#include "comp/metrology/tables/error_table.hpp"
#include "comp/metrology/tables/iso230.hpp"

namespace volcomp {

// One run: the six channels at every target, in the order of the positions; mm and rad, at the
// sensed point.
using Run = Span<const ErrorMotion>;

enum class SlopeFit : std::uint8_t {
  least_squares,
  end_points,
  keep,  // nothing removed: only right together with the squareness closure, which absorbs it
};

struct MeasuredAxis {
  char letter = '\0';
  Axis axis = Axis::x;
  JointKind kind = JointKind::prismatic;  // rotary axes keep their slopes
  Span<const double> positions;           // ascending or descending
  Span<const Run> up;  // towards increasing NC coordinate, whatever the order of the positions
  Span<const Run> down;
  std::optional<Convention>
      convention;                      // mandatory; recorded, not applied (converted once, at load)
  std::optional<Vec3> sensed_at_zero;  // mandatory: head → sensed point at q = 0, mm
  std::optional<int> kappa;            // mandatory: −1, 0 or +1
  int reference = 0;                   // target at which the table is zero
  SlopeFit slope = SlopeFit::least_squares;
  double uniform_tolerance = 1e-3;  // mm or rad
  bool allow_resampling = false;
};

enum class Warning : std::uint8_t {
  positions_reversed,
  one_direction,
  run_count_differs,
  outlier,
  steep_slope,
  knot_jump
};
[[nodiscard]] const char* code(Warning warning);

// Between neighbouring knots: more is a jump.
inline constexpr double kJump_mm = 0.020;
inline constexpr double kJump_rad = 100e-6;

struct Outlier {
  const char* direction = "up";
  int run = 0;
  int target = 0;
  int channel = 0;
  double value = 0.0;
  double median = 0.0;
};

inline constexpr std::size_t kMaxOutliers = 32;

struct BuiltTable {
  ErrorTable table;
  bool reversal_known = true;
  Convention convention = Convention::relative;
  std::array<double, kTableKnots>
      positions{};  // of the targets, ascending; as many as were measured
  std::size_t targets = 0;
  TableColumn reversal{};  // m_up − m_down at the sensed point, per target
  TableColumn s_up{};      // standard deviations (n − 1) per target
  TableColumn s_down{};
  std::array<double, 3> removed_slope{};  // mm/mm per X Y Z channel; 0 where none is removed
  Iso230Figures positioning;  // of the channel along the axis (EA/EB/EC along a rotary one)
  std::array<Warning, 6> warning{};
  std::size_t warning_count = 0;
  std::array<Outlier, kMaxOutliers> outlier{};  // listed, never dropped from the mean
  std::size_t outlier_count = 0;                // all found, also beyond kMaxOutliers

  [[nodiscard]] bool has(Warning w) const;
};

// Refuses, in this order: missing_field, too_few_knots, too_many_knots, no_runs, run_length,
// not_finite, positions_duplicate, positions_not_monotone, positions_not_uniform (or gap_too_large
// when resampling), unit_suspected, reference_out_of_range. `where` names axis, direction, run,
// target, channel. `out` is then unchanged.
Status build_table(const MeasuredAxis& measured, BuiltTable& out);

}  // namespace volcomp
