#pragma once
// One iterative learning step for a table of offsets: t ← t − w · smoothed mean error, with every
// limit that keeps a bad pass out of the table. The paper (docs/papers/internal-helical.md) calls
// it "reverse weighted compensation" and gives no formula; this one converges for 0 < w < 2.
//
// Units are those of the table: mm or rad; positions mm, rad or slots. Background, no heap.

#include <array>
#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

// Sums over the samples of one node: e = actual − original command.
struct NodeSums {
  std::uint32_t n = 0;
  double sum = 0.0;
  double sum_squares = 0.0;

  void add(double value) {
    ++n;
    sum += value;
    sum_squares += value * value;
  }
};

inline constexpr std::size_t kMostTaps = 5;

struct LearningRules {
  double weight = 0.5;              // w
  bool periodic = false;            // the node after the last is the first
  std::uint32_t least_samples = 1;  // nodes with fewer are left alone
  double dead_sigma = 0.0;          // so is a mean below this many of its standard deviations
  double most_step = 0.0;           // per update
  double most_offset = 0.0;         // of the table
  double most_slope = 0.0;          // between neighbours, per unit of position
  double spacing = 1.0;             // of the nodes
  std::array<double, kMostTaps> taps{0.25, 0.5, 0.25};
  std::size_t tap_count = 3;  // odd; 1 does not smooth
};

// Refused: not_finite, bad_setting with the field. A weight of 2 and more is allowed: the guard
// stops it.
Status check_rules(const LearningRules& rules);

enum class LearningResult : std::uint8_t {
  ok,
  nonfinite,  // in the table or the sums; nothing changed
  nodata,     // no node has enough samples; nothing changed
  slope,      // a slope would have been too steep: the whole update was dropped
};

struct LearningReport {
  LearningResult result = LearningResult::ok;
  std::size_t updated = 0;  // nodes
  std::size_t clamped = 0;  // of them at ±most_offset
  std::size_t skipped = 0;  // for want of samples or below the dead band
};

// `table`, `nodes` and `smoothed` are of one length; `smoothed` receives y, 0 where there is none.
LearningReport learning_update(const LearningRules& rules, Span<const NodeSums> nodes,
                               Span<double> table, Span<double> smoothed);

// Whether any node has enough samples.
[[nodiscard]] bool any_node_valid(const LearningRules& rules, Span<const NodeSums> nodes);

// Root mean square of the node means, over nodes with enough samples: J of the guard, in the unit
// of the table; NaN when there is none.
[[nodiscard]] double rms_of_means(const LearningRules& rules, Span<const NodeSums> nodes);

// A table of values at q0 + k·h, linear in between. Periodic: the period is N h and node N is node
// 0; else the end values are held. At least one value.
[[nodiscard]] double uniform_table_value(Span<const double> values, double q0, double h,
                                         bool periodic, double q);

}  // namespace volcomp
