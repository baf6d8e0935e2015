#pragma once
// What a correction of reversal does to the drive: while an axis turns round, its offset changes by
// some 40 µm, and the drive has to follow both. With the rate alone limited, the offset starts and
// stops within a period, which no drive can do.

#include <string>
#include <vector>

namespace volcomp::reversal {

struct ReversalOptions {
  double period_us = 125.0;    // of the targets
  double step_um = 40.0;       // of the correction, where the axis turns round
  double turning = 2.0;        // acceleration of the axis as it turns, m/s²
  double spare = 10.0;         // per cent of it that the drive has beyond
  double loop_hz = 40.0;       // of the position loop
  double most_added_um = 0.2;  // by the offset to the following error: the criterion
};

// How the offset is limited. 0 mm/s: not at all, it takes one period; 0 m/s²: rate alone.
struct OffsetPlan {
  std::string name;
  double rate = 0.0;          // mm/s
  double acceleration = 0.0;  // m/s²
};

struct OffsetEffect {
  OffsetPlan plan;
  double along_um = 0.0;    // largest following error, offset in the direction of the acceleration
  double against_um = 0.0;  // and against it
  double taken_ms = 0.0;    // from the reversal until the offset is there
  std::vector<double> error_um;  // along, from kShown_s.from on, one a period

  [[nodiscard]] double largest_um() const;
};

// What is shown of the following error, around the reversal.
struct Shown {
  double from_s = -0.01;
  double to_s = 0.05;
};
inline constexpr Shown kShown{};

struct ReversalResult {
  ReversalOptions options;
  double without_um = 0.0;  // following error without any offset
  std::vector<OffsetEffect> effects;
  std::size_t judged = 0;  // the one with rate and the acceleration that there is to spare

  [[nodiscard]] double added_um() const { return effects.at(judged).largest_um() - without_um; }
  [[nodiscard]] bool ok() const { return added_um() <= options.most_added_um; }
};

// Throws UserError where less than a nanometre per period and period is to spare, and where the
// position loop is too fast for the period.
[[nodiscard]] ReversalResult run_reversal(const ReversalOptions& options);

}  // namespace volcomp::reversal
