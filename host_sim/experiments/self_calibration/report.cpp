#include "host_sim/experiments/self_calibration/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/any_machine/verification_charts.hpp"
#include "host_sim/experiments/self_calibration/figures.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/measure/identify/identified_document.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::self_calibration {
namespace {

using nlohmann::json;

json measured_text(const Result& r) {
  std::vector<std::string> lines;
  for (const host::identify::SetUp& s : r.plan.problem.setups)
    lines.push_back(fmt::format("{}: {}, {} observations", s.name,
                                host::identify::kKindNames.at(static_cast<std::size_t>(s.kind)),
                                s.q.size()));
  if (r.touches > 0)
    lines.push_back(
        fmt::format("{} touches; centres moved by up to {:.2f} um as the errors of the "
                    "machine became known",
                    r.touches, kUmPerMm * r.found.largest_refinement));
  lines.push_back(fmt::format("{} unknowns, {} rows; chi-square {:.2f} of its degrees of freedom",
                              r.found.unknowns, r.found.rows, misfit(r)));
  for (const std::string& left_out : r.plan.unreached)
    lines.push_back("out of reach, left out: " + left_out);
  return host::in_summary(
      host::with_id("measured", host::text_section("What was measured", lines)));
}

json before_after(const Result& r) {
  const VolumeResidual predicted = r.predicted;
  return host::before_after_table(
      judged_figures(r),
      fmt::format("Volume: error vectors at {} places all over the travel, beside their best rigid "
                  "motion, which clamping and aligning a part takes out. By its covariance the "
                  "identification should leave {:.2f} um at 95 % of the places, {:.2f} um at the "
                  "worst{}. Taken from the simulated machine itself, without noise.",
                  r.before.place.size(), predicted.p95, predicted.max,
                  r.models_reversal() ? ""
                                      : "; reversal is not modelled and not in that, and the "
                                        "figures with reversal hold it"),
      std::size_t{0});
}

}  // namespace

host::Origins origins(const Options& options, const host::identify::MeasurementPlan& plan,
                      const std::vector<host::HashedInput>& inputs) {
  const sim::ShopFloor floor;
  host::Origins o;
  o.data = "simulated: no machine was measured, and artefact and noise are drawn";
  o.settings = {{"chain", host::chain_text(plan.machine.chain)},
                {"plan", plan.path},
                {"seed", fmt::format("{} (errors of the machine, places, noise)", options.seed)}};
  o.inputs = inputs;
  o.instruments = {
      options.noise
          ? fmt::format("scatter as the plan states it; every linear axis {:g} K warmer or colder "
                        "at each set-up (1 sigma); tips {:g} um, placements {:g} mm and {:g} mrad "
                        "from where the plan has them; a tracer walks {:g} um in an hour, with a "
                        "reading every {:g} s",
                        floor.growth_K, kUmPerMm * floor.stylus_mm, floor.pose_mm,
                        1e3 * floor.pose_rad, kUmPerMm * floor.drift_mm, floor.dwell_s)
          : std::string("perfect")};
  o.chosen = {
      "errors of the machine: waves, ripple and reversal drawn at random, which the functions that "
      "are identified cannot follow exactly"};
  return o;
}

json document(const Result& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = fmt::format("{}: self-calibrated", r.plan.machine.name);
  parts.subtitle = "Simulated machine with errors drawn at random";
  parts.verdict = verdict(r);
  parts.before_after = before_after(r);
  parts.plots.push_back(any_machine::volume_chart(r.plan.machine, r.before, r.after));
  parts.plots.push_back(any_machine::line_charts(r.before, r.after));
  if (!r.before.sphere.empty())
    parts.plots.push_back(any_machine::sphere_chart(r.sphere, r.before, r.after));
  for (json& plot : host::identify::identified_plots(r.plan, r.found))
    parts.plots.push_back(std::move(plot));
  parts.details.push_back(measured_text(r));
  for (json& details : host::identify::identified_details(r.plan, r.found))
    parts.details.push_back(std::move(details));
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(r.options, r.plan, r.inputs));
  return host::report_document(std::move(parts));
}

std::string summary(const Result& r) { return host::terminal_text(document(r, {})); }

}  // namespace volcomp::self_calibration
