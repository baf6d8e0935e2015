#include "host_sim/experiments/reversal/scenario.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/tick/offset_limiter.hpp"
#include "comp/tick/offset_units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/drives/accelerating_drive.hpp"

namespace volcomp::reversal {
namespace {

constexpr double kMmPerM = 1e3;
// Before the reversal, until the drive follows as it always does, and behind it, until the last
// offset is there and every swing is over.
constexpr double kBefore_s = 0.2;
constexpr double kAfter_s = 0.4;
constexpr double kSettled_s = 0.04;  // counts from here on before the reversal

double period_s(const ReversalOptions& o) { return 1e-6 * o.period_us; }

OffsetLimits limits_of(const OffsetPlan& plan, const ReversalOptions& o) {
  OffsetLimits l;
  l.limit = kMostOffsetLimit;
  l.rate = plan.rate > 0.0 ? std::max(1, whole_units(plan.rate * kNmPerMm * period_s(o)))
                           : kMostOffsetRate;
  l.soft_rate = 1;
  host::require(
      acceleration_in_units(false, kMmPerM * plan.acceleration, period_s(o), l.acceleration),
      fmt::format("{:g} % of {:g} m/s2 to spare every {:g} us", o.spare, o.turning, o.period_us));
  return l;
}

// With an acceleration that is held for a period, a critically damped loop is stable below 2 pi
// frequency x period = 1; here up to 0.63.
void require_stable(const ReversalOptions& o) {
  constexpr double kMostTurns = 0.1;  // of the loop in a period: frequency x period
  if (o.loop_hz * period_s(o) <= kMostTurns) return;
  throw host::UserError(fmt::format(
      "'--period-us' {:g}: a position loop of {:g} Hz needs a period of at most {:g} us",
      o.period_us, o.loop_hz, 1e6 * kMostTurns / o.loop_hz));
}

// The axis reverses at time 0: its targets are a parabola.
class Axis {
 public:
  explicit Axis(const ReversalOptions& o)
      : period_s_(period_s(o)),
        turning_(kMmPerM * o.turning),
        first_(-std::llround(kBefore_s / period_s_)),
        drive_({period_s_, o.loop_hz, turning_ * (1.0 + 0.01 * o.spare)}, at(first_),
               turning_ * seconds(first_)) {}

  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] std::int64_t last() const { return std::llround(kAfter_s / period_s_); }
  [[nodiscard]] double seconds(std::int64_t tick) const {
    return static_cast<double>(tick) * period_s_;
  }
  // Returns the following error, µm.
  double follow(std::int64_t tick, double offset_mm) {
    drive_.follow(at(tick) + offset_mm);
    return kUmPerMm * drive_.following_error_mm();
  }

 private:
  [[nodiscard]] double at(std::int64_t tick) const {
    const double t = seconds(tick);
    return 0.5 * turning_ * t * t;
  }

  double period_s_;
  double turning_;  // mm/s²
  std::int64_t first_;
  sim::AcceleratingDrive drive_;
};

struct Passage {
  double largest_um = 0.0;
  double taken_ms = 0.0;
  std::vector<double> error_um;  // as shown
};

// One reversal with a correction that jumps by `step_nm` in it.
Passage pass(const ReversalOptions& o, const OffsetLimits& limits, std::int32_t step_nm) {
  Axis axis(o);
  OffsetLimiter<true> limiter;
  limiter.change(OffsetBounds(limits));
  limiter.start(0);
  Passage p;
  for (std::int64_t tick = axis.first() + 1; tick <= axis.last(); ++tick) {
    const double t = axis.seconds(tick);
    const std::uint32_t held_back = limiter.follow(tick < 0 ? 0 : step_nm);
    if (held_back != 0) p.taken_ms = 1e3 * axis.seconds(tick + 1);
    const double error_um = axis.follow(tick, limiter.offset() / kNmPerMm);
    if (t >= -kSettled_s) p.largest_um = std::max(p.largest_um, std::abs(error_um));
    if (t >= kShown.from_s && t <= kShown.to_s) p.error_um.push_back(error_um);
  }
  return p;
}

OffsetEffect effect_of(const OffsetPlan& plan, const ReversalOptions& o) {
  const OffsetLimits limits = limits_of(plan, o);
  const auto step_nm = static_cast<std::int32_t>(std::lround(1e3 * o.step_um));
  const Passage along = pass(o, limits, step_nm);
  const Passage against = pass(o, limits, -step_nm);
  return {plan, along.largest_um, against.largest_um, along.taken_ms, along.error_um};
}

}  // namespace

double OffsetEffect::largest_um() const { return std::max(along_um, against_um); }

ReversalResult run_reversal(const ReversalOptions& options) {
  constexpr double kRate = 10.0;
  constexpr double kSlowRate = 4.0;
  constexpr double kTooMuch = 2.5;  // times what is to spare
  require_stable(options);
  const double spare = 0.01 * options.spare * options.turning;
  ReversalResult result;
  result.options = options;
  result.without_um =
      pass(options, limits_of({"without an offset", kRate, spare}, options), 0).largest_um;
  const std::vector<OffsetPlan> plans{
      {"in one period", 0.0, 0.0},
      {"rate", kRate, 0.0},
      {"lower rate", kSlowRate, 0.0},
      {"rate, more acceleration than to spare", kRate, kTooMuch * spare},
      {"rate and acceleration to spare", kRate, spare}};
  for (const OffsetPlan& plan : plans)
    result.effects.push_back(effect_of(plan, options));
  result.judged = result.effects.size() - 1;
  return result;
}

}  // namespace volcomp::reversal
