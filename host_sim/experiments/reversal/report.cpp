#include "host_sim/experiments/reversal/report.hpp"

#include <fmt/format.h>

#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::reversal {
namespace {

using nlohmann::json;

// Null where there is no such limit: the column then shows nothing.
json stated(double value) { return value > 0.0 ? json(value) : json(); }

json effect_table(const ReversalResult& r) {
  json rows = json::array();
  rows.push_back({"no offset", json(), json(), r.without_um, json(), json()});
  for (const OffsetEffect& e : r.effects)
    rows.push_back({e.plan.name, stated(e.plan.rate), stated(e.plan.acceleration), e.along_um,
                    e.against_um, e.taken_ms});
  json table = host::table_section(
      fmt::format("Largest following error, offset of {:g} µm at the reversal", r.options.step_um),
      json::array({host::plain_column("offset limited by", "offset"),
                   host::column("rate", "mm/s", 0, "rate_mm_per_s"),
                   host::column("acceleration", "m/s²", 3, "acceleration_m_per_s2"),
                   host::column("along", "µm", 1, "along_um"),
                   host::column("against", "µm", 1, "against_um"),
                   host::column("there after", "ms", 1, "there_after_ms")}),
      std::move(rows));
  table["name"] = "effects";
  return host::in_summary(
      host::with_id("effects", std::move(table),
                    "Along and against the acceleration with which the axis turns round."));
}

json machine_text(const ReversalOptions& o) {
  return host::in_summary(host::with_id(
      "machine",
      host::text_section(
          "", {fmt::format("axis turning at {:g} m/s², its drive has {:g} % more; speed and "
                           "acceleration fed forward, position loop of {:g} Hz, a target every "
                           "{:g} µs",
                           o.turning, o.spare, o.loop_hz, o.period_us)})));
}

json error_chart(const ReversalResult& r) {
  json series = json::array();
  for (const OffsetEffect& e : r.effects) {
    std::vector<double> ms;
    for (std::size_t i = 0; i < e.error_um.size(); ++i)
      ms.push_back(1e3 * kShown.from_s + 1e-3 * r.options.period_us * static_cast<double>(i));
    series.push_back(host::series_of(e.plan.name.c_str(), ms, e.error_um));
  }
  return host::lines_chart("following-error", "Following error, offset along the acceleration",
                           host::axis_label("time since the reversal", "ms"),
                           host::axis_label("following error", "µm"), std::move(series));
}

host::Verdict verdict_of(const ReversalResult& r) {
  const OffsetEffect& judged = r.effects.at(r.judged);
  return {r.ok(), fmt::format("with {:g} mm/s and {:g} m/s² the offset adds {:.2f} µm to the "
                              "following error, {:g} µm are allowed",
                              judged.plan.rate, judged.plan.acceleration, r.added_um(),
                              r.options.most_added_um)};
}

}  // namespace

json reversal_document(const ReversalResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "An offset at a reversal, and the drive";
  parts.verdict = verdict_of(r);
  parts.plots = json::array({error_chart(r)});
  parts.details = json::array({machine_text(r.options), effect_table(r)});
  host::Origins origins;
  origins.chosen = {"acceleration of the axis, what its drive has to spare, its position loop"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string reversal_summary(const ReversalResult& r) {
  return host::terminal_text(reversal_document(r, {}));
}

json reversal_figures(const ReversalResult& r) {
  const ReversalOptions& o = r.options;
  json figures = host::figures_of(reversal_document(r, {}));
  figures["period_us"] = o.period_us;
  figures["step_um"] = o.step_um;
  figures["turning_m_per_s2"] = o.turning;
  figures["spare_percent"] = o.spare;
  figures["loop_hz"] = o.loop_hz;
  figures["added_um"] = r.added_um();
  figures["most_added_um"] = o.most_added_um;
  figures["ok"] = r.ok();
  return figures;
}

}  // namespace volcomp::reversal
