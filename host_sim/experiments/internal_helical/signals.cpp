#include "host_sim/experiments/internal_helical/signals.hpp"

#include <fmt/format.h>

#include "comp/metrology/gears/gear_tolerance.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

// A tenth of what class 5 allows may stay.
SignalReport judge(const InternalHelicalResult& run, const char* name, const MonitorView& view,
                   const Repeatability& signal, GearDeviation feeds) {
  constexpr int kClass = 5;
  constexpr double kShare = 0.1;
  const GearSize size{2.0 * run.gear.r, run.gear.module, run.job.width_mm};
  const double tolerance = gear_limits(GearStandard::iso1328_1995, size, kClass)
                               .rounded.at(static_cast<std::size_t>(feeds));
  const double um_per_rad = kUmPerMm * run.gear.normal_lever();
  return {name, um_per_rad * signal.amplitude, view.knows_repeats, signal.ratio,
          judge_signal(signal, um_per_rad, tolerance, kShare)};
}

const char* text_of(LearningVerdict verdict) {
  constexpr std::array<const char*, 4> kTexts{"compensate", "too small", "not significant",
                                              "not repeatable"};
  return kTexts.at(static_cast<std::size_t>(verdict));
}

std::string verdict_of(const SignalReport& signal, bool with_ratio) {
  if (!signal.knows_repeats) return "";
  const std::string ratio =
      with_ratio ? fmt::format(", repeatable to {:.0f} %", 100.0 * signal.ratio) : "";
  return fmt::format("{}: {}", ratio, text_of(signal.verdict));
}

json figures_of_view(const InternalHelicalResult& run, const MonitorView& view) {
  json j;
  for (const SignalReport& s : signal_reports(run, view)) {
    j[s.name] = {{"amplitude_um", s.amplitude_um}};
    if (!s.knows_repeats) continue;
    j[s.name]["repeatability"] = s.ratio;
    j[s.name]["verdict"] = text_of(s.verdict);
  }
  return j;
}

}  // namespace

std::vector<SignalReport> signal_reports(const InternalHelicalResult& run,
                                         const MonitorView& view) {
  return {judge(run, "stroke", view, view.over_stroke, GearDeviation::profile),
          judge(run, "slots", view, view.over_slots, GearDeviation::total_pitch)};
}

json signal_figures(const InternalHelicalResult& run) {
  return {{"before", figures_of_view(run, run.detail.before)},
          {"after", figures_of_view(run, run.detail.after)}};
}

std::vector<std::string> signal_lines(const InternalHelicalResult& run) {
  std::vector<std::string> lines;
  const std::vector<SignalReport> before = signal_reports(run, run.detail.before);
  const std::vector<SignalReport> after = signal_reports(run, run.detail.after);
  for (std::size_t i = 0; i < before.size(); ++i) {
    lines.push_back(fmt::format("C out of step over the {}: ±{:.1f} µm{}; at last ±{:.1f} µm{}",
                                before[i].name, before[i].amplitude_um, verdict_of(before[i], true),
                                after[i].amplitude_um, verdict_of(after[i], false)));
  }
  return lines;
}

}  // namespace volcomp::internal_helical
