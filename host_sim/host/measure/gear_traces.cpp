#include "host_sim/host/measure/gear_traces.hpp"

#include <algorithm>
#include <utility>

#include "comp/metrology/gears/trace_filter.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kLeadEnd = 0.05;  // of the width, but not more than a module

TraceDeviations evaluated(const FlankTrace& trace, const EvaluationRange& range,
                          const std::string& name) {
  TraceDeviations figures;
  require(evaluate_trace(trace.at, trace.deviation,
                         {range.low - kTraceEnd_mm, range.high + kTraceEnd_mm}, figures),
          name);
  return figures;
}

// In the order of the places, each once, with the mean of its touches.
void merge_places(FlankTrace& trace) {
  std::vector<std::pair<double, double>> touches;
  for (std::size_t i = 0; i < trace.at.size(); ++i)
    touches.emplace_back(trace.at[i], trace.deviation[i]);
  std::sort(touches.begin(), touches.end());
  trace.at.clear();
  trace.deviation.clear();
  double count = 0.0;
  for (const auto& [at, deviation] : touches) {
    if (trace.at.empty() || at - trace.at.back() > kTraceEnd_mm) {
      trace.at.push_back(at);
      trace.deviation.push_back(deviation);
      count = 1.0;
      continue;
    }
    count += 1.0;
    trace.deviation.back() += (deviation - trace.deviation.back()) / count;
  }
}

}  // namespace

std::optional<int> worse_grade(const std::optional<int>& a, const std::optional<int>& b) {
  if (!a || !b) return std::nullopt;
  return std::max(*a, *b);
}

EvaluationRange profile_range(const InvoluteGear& gear, double used) {
  return {gear.roll_begin, gear.roll_begin + used * (gear.roll_end - gear.roll_begin)};
}

EvaluationRange lead_range(const InvoluteGear& gear) {
  const double end = std::min(kLeadEnd * gear.width, gear.module);
  return {end, gear.width - end};
}

GearSize size_of(const InvoluteGear& gear) { return {2.0 * gear.r, gear.module, gear.width}; }

void filter_as_2013(FlankTrace& trace, const EvaluationRange& range, const std::string& name) {
  merge_places(trace);
  std::vector<double> smooth(trace.at.size());
  require(filter_trace(trace.at, trace.deviation, trace_cutoff(range.high - range.low),
                       FilterOrder::line, smooth),
          name + ": filter");
  trace.deviation = std::move(smooth);
}

void grade_profile(const InvoluteGear& gear, const std::string& name, FlankTrace& trace) {
  trace.range = profile_range(gear, kRollUsed1995);
  trace.figures = evaluated(trace, trace.range, name);
  trace.figures_2013 = evaluated(trace, profile_range(gear, kRollUsed2013), name);
  trace.grade_1995 = grade_of(GearStandard::iso1328_1995, size_of(gear), GearDeviation::profile,
                              trace.figures.total);
  trace.grade_2013 = grade_of(GearStandard::iso1328_2013, size_of(gear), GearDeviation::profile,
                              trace.figures_2013.total);
}

void grade_lead(const InvoluteGear& gear, const std::string& name, FlankTrace& trace) {
  trace.range = lead_range(gear);
  trace.figures = trace.figures_2013 = evaluated(trace, trace.range, name);
  const auto grade = [&](GearStandard standard) {
    return grade_of(standard, size_of(gear), GearDeviation::lead, trace.figures.total);
  };
  trace.grade_1995 = grade(GearStandard::iso1328_1995);
  trace.grade_2013 = grade(GearStandard::iso1328_2013);
}

void grade_pitch(const InvoluteGear& gear, const std::string& name, PitchRound& round) {
  require(evaluate_pitch(round.position, round.figures), name);
  const auto grade = [&](GearStandard standard) {
    return worse_grade(
        grade_of(standard, size_of(gear), GearDeviation::single_pitch, round.figures.single),
        grade_of(standard, size_of(gear), GearDeviation::total_pitch, round.figures.total));
  };
  round.grade_1995 = grade(GearStandard::iso1328_1995);
  round.grade_2013 = grade(GearStandard::iso1328_2013);
}

}  // namespace volcomp::host
