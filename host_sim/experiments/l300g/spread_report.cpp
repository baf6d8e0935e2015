#include "host_sim/experiments/l300g/spread.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/range_of_draws.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

constexpr double kWantedShare = 0.95;

std::string filter_text(const InspectionRules& rules) {
  constexpr std::size_t kWanted = 150;
  if (!rules.filter) return "no filter";
  return fmt::format(
      "Gaussian filter of ISO 1328-1:2013, a thirtieth of the range and at least 0.25 mm{}",
      rules.traces.points < kWanted ? fmt::format(" (that edition asks for {} points)", kWanted)
                                    : "");
}

double percent_of(const std::vector<MeasuredOnce>& all, std::array<bool, 2> MeasuredOnce::*member,
                  std::size_t side) {
  const auto count = std::count_if(all.begin(), all.end(),
                                   [&](const MeasuredOnce& m) { return (m.*member)[side]; });
  return 100.0 * static_cast<double>(count) / static_cast<double>(all.size());
}

// One row a deviation and flank.
json rows_of(const SpreadResult& r) {
  json rows = json::array();
  const std::size_t teeth = r.options.rules.traces.teeth;
  const auto add = [&](const std::string& what, std::size_t side, double own, auto value,
                       const json& graded = {}) {
    std::vector<double> values;
    for (const MeasuredOnce& m : r.measurement)
      values.push_back(value(m));
    const host::RangeOfDraws range = host::range_of_draws(values);
    rows.push_back({what, kSideNames.at(side), own, range.median, range.least, range.most, graded});
  };
  // Of several teeth the worst, the mean of their figures, and the figure of their mean trace.
  const auto add_trace = [&](const std::string& what, std::size_t side, double own, auto worst,
                             auto several, auto graded) {
    const auto mean = [&](const MeasuredOnce& m) { return (m.*several)[side].mean; };
    const auto of_mean = [&](const MeasuredOnce& m) { return (m.*several)[side].of_mean_trace; };
    add(
        teeth > 1 ? fmt::format("{}, worst of {} teeth", what, teeth) : what, side, own,
        [&](const MeasuredOnce& m) { return (m.*worst)[side]; },
        percent_of(r.measurement, graded, side));
    if (teeth == 1) return;
    add(what + ", mean of them", side, own, mean);
    add(what + " of the mean trace", side, own, of_mean);
  };
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    add_trace("F_alpha", side, r.truth.profile[side].figures.total, &MeasuredOnce::profile,
              &MeasuredOnce::profile_teeth, &MeasuredOnce::own_profile);
    add_trace("F_beta", side, r.truth.lead[side].figures.total, &MeasuredOnce::lead,
              &MeasuredOnce::lead_teeth, &MeasuredOnce::own_lead);
    add("F_p", side, r.truth.pitch[side].figures.total,
        [side](const MeasuredOnce& m) { return m.pitch[side]; });
    if (!r.measurement.front().on_centre) continue;
    add("F_alpha, measuring centre", side, r.truth.profile[side].figures.total,
        [side](const MeasuredOnce& m) { return m.on_centre.value().at(side); });
    add("F_beta, measuring centre", side, r.truth.lead[side].figures.total,
        [side](const MeasuredOnce& m) { return m.on_centre.value().at(2 + side); });
  }
  return rows;
}

json table(const SpreadResult& r) {
  json made = host::table_section(
      fmt::format("{} measurements of the gear, compensated", r.measurement.size()),
      {host::plain_column("figure", "figure"), host::plain_column("flank", "flank"),
       host::column("of the gear", "µm", 2, "own_um"), host::column("median", "µm", 2, "median_um"),
       host::column("least", "µm", 2, "least_um"), host::column("most", "µm", 2, "most_um"),
       host::column("own grade", "%", 0, "own_grade_percent")},
      rows_of(r));
  made["name"] = "spread";
  return host::in_summary(
      host::with_id("spread", std::move(made),
                    fmt::format("Probe {}: {}; radius {}; {} touch{} of a point, {} points within "
                                "a range, {}. Readings of the tracer that "
                                "identifies the axes scatter by {:.2g} µm.",
                                sim::kProbeClasses.at(r.options.probe).name,
                                sim::probe_text(sim::kProbeClasses.at(r.options.probe)),
                                r.options.map_radius ? "mapped on a sphere" : "that of the mandrel",
                                r.options.rules.touches, r.options.rules.touches == 1 ? "" : "es",
                                r.options.rules.traces.points, filter_text(r.options.rules),
                                r.options.tracer_um)));
}

json histogram(const SpreadResult& r) {
  std::vector<double> values;
  for (const MeasuredOnce& m : r.measurement)
    values.insert(values.end(), m.profile.begin(), m.profile.end());
  return host::with_id("histogram", {{"type", "histogram"},
                                     {"title", "Total profile deviation F_alpha, both flanks"},
                                     {"x", host::axis_label("F_alpha", "µm")},
                                     {"series", {{{"name", "measured"}, {"values", values}}}}});
}

}  // namespace

host::Verdict spread_verdict(const SpreadResult& r) {
  const double share = r.share_of_own_grades();
  const bool good = share >= kWantedShare;
  const auto worse_before = std::count_if(r.measurement.begin(), r.measurement.end(),
                                          [](const MeasuredOnce& m) { return m.before_worse; });
  return {
      good,
      fmt::format(
          "the compensated machine gives the gear its own grades in {:.0f} % of {} "
          "measurements, profile and lead ({:g} % wanted); uncompensated it gave a worse one in {}",
          100.0 * share, r.measurement.size(), 100.0 * kWantedShare, worse_before)};
}

nlohmann::json spread_document(const SpreadResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "L300G: the gear measured with a probe that scatters";
  parts.subtitle =
      "Simulated gear grinder after Yang et al.; every touch through drives, bus and node";
  parts.verdict = spread_verdict(r);
  parts.before_after = table(r);
  parts.plots = json::array({histogram(r)});
  host::Origins origins;
  origins.settings = {
      {"errors of the machine", r.options.errors},
      {"seed", fmt::format("{}, draws 0 to {}", r.options.seed, r.measurement.size() - 1)}};
  origins.inputs = r.inputs;
  origins.instruments = {
      fmt::format("touch probe of the class {}: scatter of each touch, on the "
                  "mandrel and on the gear",
                  sim::kProbeClasses.at(r.options.probe).name),
      fmt::format("tracer of the identification: {:.2g} µm of a reading", r.options.tracer_um)};
  origins.chosen = {"amounts and signs of the errors, such that they add up"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string spread_summary(const SpreadResult& r) {
  return host::terminal_text(spread_document(r, {}));
}

nlohmann::json spread_figures(const SpreadResult& r) {
  json figures = r.settings;
  figures.update({{"version", host::kVersion},
                  {"measurements", r.measurement.size()},
                  {"share_of_own_grades", r.share_of_own_grades()},
                  {"spread", host::figures_of_table(table(r))}});
  return figures;
}

}  // namespace volcomp::l300g
