#include "tests/host_sim/experiments/l300g/scattered_flank.hpp"

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {

double touch_noise(std::uint32_t draw, std::uint32_t trace, std::uint32_t touch) {
  constexpr std::uint64_t kSeed = 1;
  return normal(kSeed, {static_cast<std::uint32_t>(RandomStream::probe), draw, trace, touch});
}

ScatteredFlank::ScatteredFlank(Traced what, const Touching& how) : what_(what), how_(how) {
  const OwnDeviation own(gear_);
  const Flank flank{FlankSide::left, 0};
  const bool profile = what == Traced::profile;
  range_ = profile ? host::profile_range(gear_, host::kRollUsed1995) : host::lead_range(gear_);
  for (const FlankTouch& touch : profile ? profile_touches(gear_, flank, how.points)
                                         : lead_touches(gear_, flank, how.points)) {
    const double at = profile ? touch.roll_length : touch.x;
    at_.push_back(at);
    own_.push_back(kUmPerMm * own(touch.roll_length, touch.x));
  }
  if (how.filter) find_filter();
}

// The filter is linear and its places never change: what it makes of each point alone says all of
// it, and a sum is faster than the regressions.
void ScatteredFlank::find_filter() {
  for (std::size_t i = 0; i < at_.size(); ++i) {
    host::FlankTrace trace;
    trace.at = at_;
    trace.deviation.assign(at_.size(), 0.0);
    trace.deviation[i] = 1.0;
    host::filter_as_2013(trace, range_, "trace");
    filter_.push_back(trace.deviation);
  }
}

std::vector<double> ScatteredFlank::touched(std::uint32_t draw, std::uint32_t tooth) const {
  const double share = how_.sigma_um / static_cast<double>(how_.touches);
  std::vector<double> deviation = own_;
  std::uint32_t touch = 0;
  for (double& d : deviation)
    for (std::size_t k = 0; k < how_.touches; ++k)
      d += share * touch_noise(draw, tooth, touch++);
  return deviation;
}

std::vector<double> ScatteredFlank::evaluated(const std::vector<double>& touched) const {
  if (filter_.empty()) return touched;
  std::vector<double> smooth(touched.size(), 0.0);
  for (std::size_t i = 0; i < touched.size(); ++i)
    for (std::size_t j = 0; j < smooth.size(); ++j)
      smooth[j] += touched[i] * filter_[i][j];
  return smooth;
}

double ScatteredFlank::total(const std::vector<double>& deviation) const {
  TraceDeviations figures;
  host::require(
      evaluate_trace(at_, deviation,
                     {range_.low - host::kTraceEnd_mm, range_.high + host::kTraceEnd_mm}, figures),
      "trace");
  return figures.total;
}

FoundTotals ScatteredFlank::measured(std::uint32_t draw) const {
  FoundTotals found;
  std::vector<double> sum(at_.size(), 0.0);
  std::vector<double> mean(at_.size());
  for (std::uint32_t tooth = 0; tooth < how_.teeth; ++tooth) {
    const std::vector<double> trace = evaluated(touched(draw, tooth));
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += trace[i];
      mean[i] = sum[i] / (tooth + 1.0);
    }
    found.tooth.push_back(total(trace));
    found.mean_trace.push_back(total(mean));
  }
  return found;
}

bool ScatteredFlank::has_grade_4(double total_um) const {
  const auto grade =
      grade_of(GearStandard::iso1328_1995, host::size_of(gear_),
               what_ == Traced::profile ? GearDeviation::profile : GearDeviation::lead, total_um);
  return grade && *grade <= 4;
}

}  // namespace volcomp::l300g
