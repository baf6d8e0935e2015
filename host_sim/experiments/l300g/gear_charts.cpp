#include "host_sim/experiments/l300g/gear_charts.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/experiments/l300g/figures.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

constexpr auto kOld = GearStandard::iso1328_1995;
constexpr auto kNew = GearStandard::iso1328_2013;

using Traces = std::array<host::FlankTrace, 2> GearInspection::*;

// What distinguishes profile from lead.
struct TraceKind {
  const char* id;
  const char* title;
  const char* symbol;  // Greek index of the deviations
  GearDeviation deviation;
  json place;  // axis of the chart
  Traces traces;
};

const TraceKind& profile_kind() {
  static const TraceKind kind{"profile",
                              "Profile",
                              "α",
                              GearDeviation::profile,
                              host::axis_label("roll length", "mm"),
                              &GearInspection::profile};
  return kind;
}

const TraceKind& lead_kind() {
  static const TraceKind kind{
      "lead", "Lead", "β", GearDeviation::lead, host::axis_label("x", "mm"), &GearInspection::lead};
  return kind;
}

// The grade the gear itself has: what a band shows.
int own_grade(const host::FlankTrace& truth) { return truth.grade_1995.value_or(last_grade(kOld)); }

// Within the range, halfway between its extremes: so a trace fits into a band as wide as its
// tolerance exactly when it is within it.
json trace_series(const char* name, const host::FlankTrace& trace) {
  std::vector<double> counted;
  for (std::size_t i = 0; i < trace.at.size(); ++i) {
    if (trace.at[i] >= trace.range.low && trace.at[i] <= trace.range.high)
      counted.push_back(trace.deviation[i]);
  }
  const auto [low, high] = std::minmax_element(counted.begin(), counted.end());
  std::vector<double> x = trace.deviation;
  for (double& um : x)
    um -= 0.5 * (*low + *high);
  json series = host::series_of(name, x, trace.at);
  series["emphasis"] = std::string("compensated") == name;
  return series;
}

json band_series(const L300gResult& r, const TraceKind& kind, std::size_t side) {
  const host::FlankTrace& truth = (r.truth.*kind.traces)[side];
  const int grade = own_grade(truth);
  const auto deviation = static_cast<std::size_t>(kind.deviation);
  const double half = 0.5 * gear_limits(kOld, host::size_of(r.gear), grade).rounded[deviation];
  const double low = truth.range.low;
  const double high = truth.range.high;
  return {{"name", fmt::format("tolerance, grade {}", grade)},
          {"style", "dashed"},
          {"x", {-half, -half, 0.0, half, half}},
          {"y", {low, high, nullptr, high, low}}};
}

std::string values(const char* when, const host::FlankTrace& t, const char* symbol) {
  return fmt::format("{}: F{} {:.1f} µm (grade {}), ff{} {:.1f}, fH{} {:.1f}. ", when, symbol,
                     t.figures.total, grade_text(t.grade_1995, kOld), symbol, t.figures.form,
                     symbol, t.figures.slope);
}

json trace_chart(const L300gResult& r, const TraceKind& kind, std::size_t side) {
  const host::FlankTrace& before = (r.before.*kind.traces)[side];
  const host::FlankTrace& after = (r.after.*kind.traces)[side];
  std::vector<json> series{band_series(r, kind, side), trace_series("uncompensated", before),
                           trace_series("compensated", after)};
  std::string text = values("Before", before, kind.symbol) + values("After", after, kind.symbol);
  if (r.on_centre) {
    const host::FlankTrace& centre = ((*r.on_centre).*kind.traces)[side];
    series.push_back(trace_series("on a measuring centre", centre));
    text += values("On the centre", centre, kind.symbol);
  }
  return host::lines_chart(
      fmt::format("{}-{}", kind.id, kSideNames[side]), fmt::format("{} flank", kSideNames[side]),
      host::axis_label("deviation, + = excess", "µm"), kind.place, series, text);
}

json trace_group(const L300gResult& r, const TraceKind& kind) {
  json charts = json::array();
  for (std::size_t side = 0; side < kSides.size(); ++side)
    charts.push_back(trace_chart(r, kind, side));
  return host::chart_group(
      kind.id, fmt::format("{} of tooth 1", kind.title), charts,
      "Each trace stands halfway between its extremes in the evaluation range. The band is as wide "
      "as the tolerance of the total deviation in the grade of the gear itself: a trace fits into "
      "it or has a worse grade.");
}

json pitch_chart(const L300gResult& r, std::size_t side) {
  const std::vector<double> tooth = host::counted(static_cast<std::size_t>(r.gear.teeth));
  const host::PitchRound& before = r.before.pitch[side];
  const host::PitchRound& after = r.after.pitch[side];
  const auto values = [](const char* when, const host::PitchRound& p) {
    return fmt::format("{}: Fp {:.1f} µm, fpt {:.1f} µm (grade {}). ", when, p.figures.total,
                       p.figures.single, grade_text(p.grade_1995, kOld));
  };
  return host::lines_chart(fmt::format("pitch-{}", kSideNames[side]),
                           fmt::format("{} flank", kSideNames[side]), host::axis_label("tooth", ""),
                           host::axis_label("position deviation", "µm"),
                           {host::series_of("uncompensated", tooth, before.position),
                            host::series_of("compensated", tooth, after.position)},
                           values("Before", before) + values("After", after));
}

json trace_row(const std::string& name, const host::FlankTrace& t) {
  return {name,
          t.figures.total,
          t.figures.form,
          t.figures.slope,
          grade_text(t.grade_1995, kOld),
          grade_text(t.grade_2013, kNew)};
}

}  // namespace

json profile_charts(const L300gResult& r) { return trace_group(r, profile_kind()); }
json lead_charts(const L300gResult& r) { return trace_group(r, lead_kind()); }

json pitch_charts(const L300gResult& r) {
  return host::chart_group("pitch", "Pitch of all teeth", {pitch_chart(r, 0), pitch_chart(r, 1)},
                           "The simulated gear has no pitch deviations of its own.");
}

json gear_table(const L300gResult& r) {
  json rows = json::array();
  for (const TraceKind* kind : {&profile_kind(), &lead_kind()}) {
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      const auto add = [&](const char* when, const GearInspection& gear) {
        rows.push_back(
            trace_row(fmt::format("{}, {} flank, {}", kind->title, kSideNames[side], when),
                      (gear.*kind->traces)[side]));
      };
      add("before", r.before);
      add("after", r.after);
      if (r.on_centre) add("on a measuring centre", *r.on_centre);
      add("the gear itself", r.truth);
    }
  }
  return host::in_summary(host::with_id(
      "gear",
      host::table_section("Deviations and grades",
                          {host::plain_column("trace"), host::column("F", "µm", 2),
                           host::column("f_f", "µm", 2), host::column("f_H", "µm", 2),
                           host::plain_column("grade 1995"), host::plain_column("class 2013")},
                          rows),
      "Grades of the total deviation F. ISO 1328-1:1995 (= GB/T 10095.1-2008): from the geometric "
      "means of its ranges of sizes (d 50 to 125, m 3.5 to 6, b 20 to 40 mm for the master gear), "
      "limits rounded as the standard does; profile over 92 % of the active flank. ISO "
      "1328-1:2013: from the sizes themselves, profile over 95 %. "
      "The formulas were not checked against the printed standards."));
}

}  // namespace volcomp::l300g
