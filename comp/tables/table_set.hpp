#pragma once
// One complete set of run-time tables of a machine, folded for its kernel. Two of them make the
// double buffer of a Compensator; a set is written in the background and only read by the tick.

#include <array>

#include "comp/machine/float3.hpp"
#include "comp/tables/axis_lookup.hpp"
#include "comp/tables/runtime_machine.hpp"
#include "comp/tables/tables_view.hpp"

namespace volcomp {

template <std::size_t Axes, std::size_t Knots>
struct TableSet {
  static_assert(Knots >= 2 && Knots <= kMaxLookupKnots && Axes <= kMaxAxes);

  std::array<AxisLookup, Axes> lookup{};
  std::array<std::array<std::array<Knot, 2>, Knots>, Axes> rows{};  // [axis][knot][direction]
  std::array<Float3, Axes>
      direction{};  // squareness per nm of a linear axis (recursion only: folded holds it in rows)
  std::array<Float3, Axes>
      travel_axis{};  // unit vector of a linear motion in base (folded, rotated joints only)
  std::array<Float3, Axes> turn_before{};  // constant angles met before an axis in the folded walk
  std::array<Float3, kMaxCorrecting> inverse{};  // rows of J⁻¹ where it is constant but not aligned
  Float3 tool_nm{};
  std::uint32_t image_crc = 0;  // of the image it was made from
  std::uint32_t checksum =
      0;  // CRC-32 of everything before it, for the background scrub; stays last
};

// Where the folder writes: the same set without its capacities, so that folding is compiled once.
struct TableSetView {
  AxisLookup* lookup;
  Float3* direction;
  Float3* travel_axis;
  Float3* turn_before;
  Float3* inverse;
  Float3* tool_nm;
  std::array<std::array<Knot, 2>*, kMaxAxes> rows{};
  std::size_t axes;
  std::size_t knots;  // capacity

  template <std::size_t Axes, std::size_t Knots>
  explicit TableSetView(TableSet<Axes, Knots>& set)
      : lookup(set.lookup.data()),
        direction(set.direction.data()),
        travel_axis(set.travel_axis.data()),
        turn_before(set.turn_before.data()),
        inverse(set.inverse.data()),
        tool_nm(&set.tool_nm),
        axes(Axes),
        knots(Knots) {
    for (std::size_t a = 0; a < Axes; ++a)
      rows[a] = set.rows[a].data();
  }
};

// What folding found out about a set; all worst cases over the tables.
struct FoldReport {
  double bound_nm =
      0.0;  // S = Σ|δ| + Σ|ε||r| of one component: the tick's arithmetic error is ≤ 8·2^-24·S
  double contraction = 0.0;  // max |Δa/h| + max |ε| =: ‖J‖; above 1e-2 the tables are garbage
  bool within_1nm = false;  // S ≤ 1 mm: arithmetic (8·2⁻²⁴·S) plus rounding (0.5 nm) below 1 nm
  // By NC axis, nm: how far reversals move its offset, its own where that is against the motion,
  // and those of other axes. 0 where directions_follow_offsets() does not hold.
  std::array<std::int32_t, kMaxAxes> reversal_nm{};
};

inline constexpr double kMaxBound_nm = 1.0e7;    // 10 mm: larger is implausible
inline constexpr double kClaimBound_nm = 1.0e6;  // 1 mm
inline constexpr double kMaxContraction = 1e-2;

// Folds the tables for `tool_point` (mm, tool frame), axes as grown as in `tables`, in double and
// writes them in float. Background only. Refuses axes_mismatch (other number of axes),
// machine_mismatch (another chain), not_finite, what check_knots refuses, bound_exceeded,
// contraction_exceeded, no_authority; the set is then partly written and must not be activated.
Status fold_tables(const TablesView& tables, const RuntimeChain& runtime, const Vec3& tool_point,
                   const TableSetView& set, FoldReport& report);

}  // namespace volcomp
