#include "host_sim/host/measure/identify/identified_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

// Axes whose ends no reading came near: a segment of their functions.
std::vector<std::string> unvisited(const MeasurementPlan& plan, const Identified& found) {
  std::vector<std::string> lines;
  for (const Visited& v : found.visited) {
    const AxisFile& axis = plan.machine.axes[v.axis];
    const double segment =
        (axis.hi - axis.lo) / static_cast<double>(plan.problem.model.functions.at(v.axis).segments);
    if (axis.full_turn() || (v.lo - axis.lo <= segment && axis.hi - v.hi <= segment)) continue;
    const double unit = axis.rotary ? kDegPerRad : 1.0;
    lines.push_back(fmt::format(
        "warning: {} was measured from {:.1f} to {:.1f} {} only; beyond a segment from there its "
        "functions are carried on",
        axis.letter, unit * v.lo, unit * v.hi, axis.rotary ? "deg" : "mm"));
  }
  return lines;
}

// What is wrong with a set-up, empty: nothing.
std::string remark_on(const SetUpCheck& c) {
  if (c.left_out && *c.left_out > chi2_limit_99(static_cast<double>(*c.left_out_dof)))
    return "the others do not predict it";
  if (c.too_quiet())
    return "its readings leave less than a tenth of their uncertainty: is a unit wrong?";
  return "";
}

json setup_rows(const MeasurementPlan& plan, const Identified& found) {
  json rows = json::array();
  for (std::size_t k = 0; k < found.consistency.setups.size(); ++k) {
    const SetUpCheck& c = found.consistency.setups[k];
    const SetUp& s = plan.problem.setups[k];
    rows.push_back(json::array(
        {s.name, kKindNames.at(static_cast<std::size_t>(s.kind)), c.rows,
         c.chi2 / std::max(c.redundancy, 1e-9),
         c.left_out ? json(*c.left_out / static_cast<double>(*c.left_out_dof)) : json("-"),
         remark_on(c)}));
  }
  return rows;
}

std::vector<std::string> closing_lines(const MeasurementPlan& plan, const Identified& found) {
  std::vector<std::string> lines = unvisited(plan, found);
  if (found.rank.nullity_functions > plan.problem.model.gauge.size())
    lines.push_back(fmt::format(
        "warning: {} combinations of these are held by nothing but what is known of the styli: {}",
        found.rank.nullity_functions - plan.problem.model.gauge.size(),
        fmt::join(found.rank.unseen, ", ")));
  const Consistency& c = found.consistency;
  lines.push_back(fmt::format(
      "{} rows, {} unknowns: chi-square {:.1f} of {} degrees of freedom, 99 % "
      "limit {:.1f}{}",
      found.rows, found.unknowns, c.chi2, c.dof, c.chi2_99,
      c.good() ? ""
               : fmt::format("; uncertainties stated too small by a factor "
                             "of {:.2f}, or something is wrong",
                             std::sqrt(c.chi2 / static_cast<double>(std::max<Index>(c.dof, 1))))));
  if (found.refinements > 0)
    lines.push_back(fmt::format(
        "Centres of spheres refined in {} rounds, by up to {:.2f} µm in one: the errors of the "
        "machine over a sphere",
        found.refinements, kUmPerMm * found.largest_refinement));
  for (const FoundStylus& s : found.styli)
    if (s.doubtful())
      lines.push_back(fmt::format(
          "stylus \"{}\" is off by ({:.3f}, {:.3f}, {:.3f}) mm, more than 3 times what is known of "
          "it ({:g} mm): its length or its offset is another",
          plan.problem.styli[s.stylus].name, s.correction.x(), s.correction.y(), s.correction.z(),
          s.known));
  for (const ReadingPlace& o : found.outliers)
    lines.push_back(fmt::format("outlier: observation {} of \"{}\"", o.observation + 1,
                                plan.problem.setups[o.setup].name));
  lines.push_back(volume_line(found.volume));
  if (const auto& curvature = plan.problem.model.curvature)
    lines.push_back(
        fmt::format("Stated beforehand: within a segment a slope changes by about {:g} µm or {:g} "
                    "µrad a segment",
                    kUmPerMm * curvature->mm, kUradPerRad * curvature->rad));
  if (!plan.active_image.empty())
    lines.push_back(fmt::format(
        "Measured with the tables {} at work. Positions are those of the encoders, so these are "
        "the errors of the machine, not what those tables left of them",
        plan.active_image));
  lines.emplace_back(
      "Not in these uncertainties: what the splines cannot follow, reversal that is not an "
      "unknown, and drift within a set-up");
  return lines;
}

}  // namespace

json identified_sections(const MeasurementPlan& plan, const Identified& found) {
  json sections = json::array();
  if (!found.functions.empty()) sections.push_back(function_section(found.functions, true));
  if (json values = value_section(found.values, found.squareness, true); !values.is_null())
    sections.push_back(std::move(values));
  sections.push_back(table_section(
      "Set-ups",
      {plain_column("set-up"), plain_column("kind"), plain_column("rows"),
       column("chi-square / redundancy", "", 2), column("without it", "", 2), plain_column("")},
      setup_rows(plan, found)));
  sections.push_back(text_section("Consistency and uncertainty", closing_lines(plan, found)));
  return sections;
}

std::string identified_text(const MeasurementPlan& plan, const Identified& found) {
  return text_of_sections(identified_sections(plan, found));
}

json identified_json(const MeasurementPlan& plan, const Identified& found) {
  json out = plan_json(plan);
  out["functions"] = functions_json(plan, found.functions);
  out["values"] = values_json(found.values);
  out["squareness"] = json();
  if (found.squareness) {
    const auto urad = [](const Measured& m) {
      return json{{"urad", kUradPerRad * m.value}, {"u_urad", kUradPerRad * m.u}};
    };
    out["squareness"] = {{"a_xy", urad(found.squareness->a_xy)},
                         {"a_xz", urad(found.squareness->a_xz)},
                         {"a_yz", urad(found.squareness->a_yz)}};
  }
  out["styli"] = json::array();
  for (const FoundStylus& s : found.styli)
    out["styli"].push_back(
        {{"name", plan.problem.styli[s.stylus].name},
         {"correction_mm", {s.correction.x(), s.correction.y(), s.correction.z()}},
         {"known_mm", s.known < kFree ? json(s.known) : json()},
         {"doubtful", s.doubtful()}});
  out["u_volume"] = volume_json(found.volume);
  const Consistency& c = found.consistency;
  out["chi2"] = c.chi2;
  out["dof"] = c.dof;
  out["chi2_99"] = c.chi2_99;
  out["consistent"] = c.good();
  out["rows"] = found.rows;
  out["unknowns"] = found.unknowns;
  out["robust"] = found.robust;
  out["refinement"] = {{"rounds", found.refinements},
                       {"largest_um", kUmPerMm * found.largest_refinement}};
  out["setups"] = json::array();
  for (std::size_t k = 0; k < c.setups.size(); ++k) {
    const SetUpCheck& s = c.setups[k];
    out["setups"].push_back({{"name", plan.problem.setups[k].name},
                             {"rows", s.rows},
                             {"redundancy", s.redundancy},
                             {"chi2", s.chi2},
                             {"too_quiet", s.too_quiet()},
                             {"leave_out", s.left_out ? json(*s.left_out) : json()},
                             {"leave_out_dof", s.left_out_dof ? json(*s.left_out_dof) : json()}});
  }
  out["outliers"] = json::array();
  for (const ReadingPlace& o : found.outliers)
    out["outliers"].push_back(
        {{"setup", plan.problem.setups[o.setup].name}, {"observation", o.observation + 1}});
  return out;
}

}  // namespace volcomp::host::identify
