#include "host_sim/host/measure/identify/identified_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

// More than these a function is weakly known, k = 1.
constexpr double kWeak_mm = 5e-3;
constexpr double kWeak_rad = 20e-6;
constexpr double kCover = 2.0;
constexpr double kUradPerRad = 1e6;

double shown(const Quantity& quantity, double value) {
  return value * (quantity.angular() ? kUradPerRad : kUmPerMm);
}

const char* unit_name(const Quantity& quantity) { return quantity.angular() ? "urad" : "um"; }

bool weak(const FoundFunction& f) {
  return f.largest_u() > (f.quantity.angular() ? kWeak_rad : kWeak_mm);
}

// Largest less smallest value.
double range_of(const FoundFunction& f) {
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (const Measured& v : f.value) {
    least = std::min(least, v.value);
    most = std::max(most, v.value);
  }
  return most - least;
}

json function_rows(const std::vector<FoundFunction>& functions, bool values) {
  json rows = json::array();
  for (const FoundFunction& f : functions) {
    json row = json::array({f.quantity.name});
    if (values) row.push_back(shown(f.quantity, range_of(f)));
    row.push_back(kCover * shown(f.quantity, f.largest_u()));
    row.push_back(unit_name(f.quantity));
    row.push_back(weak(f) ? "weak" : "");
    rows.push_back(row);
  }
  return rows;
}

json function_section(const std::vector<FoundFunction>& functions, bool values) {
  json columns = json::array({plain_column("function")});
  if (values) columns.push_back(column("range", "", 2));
  columns.push_back(column("largest U (k = 2)", "", 2));
  columns.push_back(plain_column(""));
  columns.push_back(plain_column(""));
  return table_section("Error functions (body, moving side)", columns,
                       function_rows(functions, values));
}

json value_section(const std::vector<FoundValue>& values, bool measured) {
  json rows = json::array();
  for (const FoundValue& v : values) {
    json row = json::array({v.quantity.name});
    if (measured) row.push_back(shown(v.quantity, v.value.value));
    row.push_back(kCover * shown(v.quantity, v.value.u));
    row.push_back(unit_name(v.quantity));
    rows.push_back(row);
  }
  json columns = json::array({plain_column("")});
  if (measured) columns.push_back(column("value", "", 2));
  columns.push_back(column("U (k = 2)", "", 2));
  columns.push_back(plain_column(""));
  return table_section("Reversals, places of rotary axes", columns, rows);
}

std::string volume_line(const FoundVolume& v) {
  return fmt::format(
      "Error of the functional point over the travels, beside the best rigid motion: U (k = 2) "
      "{:.2f} "
      "um rms, {:.2f} um at 95 % of the places, {:.2f} um at most",
      kCover * kUmPerMm * v.rms, kCover * kUmPerMm * v.p95, kCover * kUmPerMm * v.max);
}

json volume_json(const FoundVolume& v) {
  return {{"rms_um", kUmPerMm * v.rms}, {"p95_um", kUmPerMm * v.p95}, {"max_um", kUmPerMm * v.max}};
}

json functions_json(const MeasurementPlan& plan, const std::vector<FoundFunction>& functions) {
  json out = json::array();
  for (const FoundFunction& f : functions) {
    const AxisFile& axis = plan.machine.axes[f.quantity.axis];
    json at = json::array();
    json value = json::array();
    json u = json::array();
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      at.push_back(axis.rotary ? kDegPerRad * f.at[k] : f.at[k]);
      value.push_back(shown(f.quantity, f.value[k].value));
      u.push_back(shown(f.quantity, f.value[k].u));
    }
    out.push_back({{"name", f.quantity.name},
                   {"axis", std::string(1, axis.letter)},
                   {"channel", kChannelNames.at(f.quantity.channel)},
                   {"at_unit", axis.rotary ? "deg" : "mm"},
                   {"unit", unit_name(f.quantity)},
                   {"at", at},
                   {"value", value},
                   {"u", u},
                   {"weak", weak(f)}});
  }
  return out;
}

json values_json(const std::vector<FoundValue>& values) {
  json out = json::array();
  for (const FoundValue& v : values)
    out.push_back({{"name", v.quantity.name},
                   {"unit", unit_name(v.quantity)},
                   {"value", shown(v.quantity, v.value.value)},
                   {"u", shown(v.quantity, v.value.u)}});
  return out;
}

json plan_json(const MeasurementPlan& plan) {
  return {{"plan", plan.path},
          {"machine", plan.machine.name},
          {"machine_id", plan.machine.id},
          {"positions", plan.commanded ? "command" : "actual"},
          {"temperature_C", plan.temperature_C}};
}

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

json setup_rows(const MeasurementPlan& plan, const Identified& found) {
  json rows = json::array();
  for (std::size_t k = 0; k < found.consistency.setups.size(); ++k) {
    const SetUpCheck& c = found.consistency.setups[k];
    const SetUp& s = plan.problem.setups[k];
    const bool moved =
        c.left_out && *c.left_out > chi2_limit_99(static_cast<double>(*c.left_out_dof));
    rows.push_back(json::array(
        {s.name, kKindNames.at(static_cast<std::size_t>(s.kind)), c.rows,
         c.chi2 / std::max(c.redundancy, 1e-9),
         c.left_out ? json(*c.left_out / static_cast<double>(*c.left_out_dof)) : json("-"),
         moved ? "the others do not predict it" : ""}));
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
        "Centres of spheres refined in {} rounds, by up to {:.2f} um in one: the errors of the "
        "machine over a sphere",
        found.refinements, kUmPerMm * found.largest_refinement));
  for (const ReadingPlace& o : found.outliers)
    lines.push_back(fmt::format("outlier: observation {} of \"{}\"", o.observation + 1,
                                plan.problem.setups[o.setup].name));
  if (found.squareness) {
    const auto text = [](const Measured& m) {
      return fmt::format("{:.1f} ± {:.1f}", kUradPerRad * m.value, kCover * kUradPerRad * m.u);
    };
    lines.push_back(fmt::format("Squareness, Y the datum, urad (k = 2): a_xy {}, a_xz {}, a_yz {}",
                                text(found.squareness->a_xy), text(found.squareness->a_xz),
                                text(found.squareness->a_yz)));
  }
  lines.push_back(volume_line(found.volume));
  if (const auto& curvature = plan.problem.model.curvature)
    lines.push_back(
        fmt::format("Stated beforehand: within a segment a slope changes by about {:g} um or {:g} "
                    "urad a segment",
                    kUmPerMm * curvature->mm, kUradPerRad * curvature->rad));
  lines.emplace_back(
      "Not in these uncertainties: what the splines cannot follow, reversal that is not an "
      "unknown, "
      "and drift within a set-up");
  return lines;
}

}  // namespace

std::string identified_text(const MeasurementPlan& plan, const Identified& found) {
  json sections = json::array();
  sections.push_back(function_section(found.functions, true));
  if (!found.values.empty()) sections.push_back(value_section(found.values, true));
  sections.push_back(table_section(
      "Set-ups",
      {plain_column("set-up"), plain_column("kind"), plain_column("rows"),
       column("chi-square / redundancy", "", 2), column("without it", "", 2), plain_column("")},
      setup_rows(plan, found)));
  sections.push_back(text_section("", closing_lines(plan, found)));
  return text_of_sections(sections);
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
                             {"leave_out", s.left_out ? json(*s.left_out) : json()},
                             {"leave_out_dof", s.left_out_dof ? json(*s.left_out_dof) : json()}});
  }
  out["outliers"] = json::array();
  for (const ReadingPlace& o : found.outliers)
    out["outliers"].push_back(
        {{"setup", plan.problem.setups[o.setup].name}, {"observation", o.observation + 1}});
  return out;
}

std::string functions_csv(const MeasurementPlan& plan,
                          const std::vector<FoundFunction>& functions) {
  std::string text = "function,position,unit of position,value,u,unit\n";
  for (const FoundFunction& f : functions) {
    const bool rotary = plan.machine.axes[f.quantity.axis].rotary;
    for (std::size_t k = 0; k < f.at.size(); ++k)
      text += fmt::format("{},{:.6f},{},{:.4f},{:.4f},{}\n", f.quantity.name,
                          rotary ? kDegPerRad * f.at[k] : f.at[k], rotary ? "deg" : "mm",
                          shown(f.quantity, f.value[k].value), shown(f.quantity, f.value[k].u),
                          unit_name(f.quantity));
  }
  return text;
}

std::string foreseen_text(const MeasurementPlan& plan, const Foreseen& foreseen) {
  json sections = json::array();
  std::vector<std::string> seen;
  for (const auto& group : foreseen.rank.together)
    seen.push_back(group.size() > 1 ? fmt::format("Seen only together: {}", fmt::join(group, ", "))
                                    : fmt::format("Not seen: {}", group.front()));
  const std::size_t gauge = plan.problem.model.gauge.size();
  seen.push_back(fmt::format("{} combinations of errors are not seen, {} are held by the gauge{}",
                             foreseen.rank.nullity_functions, gauge,
                             foreseen.solvable
                                 ? ": with it and what is known beforehand everything is determined"
                                 : ": the plan is not enough"));
  sections.push_back(text_section("What the plan sees", seen));
  if (foreseen.solvable) {
    sections.push_back(function_section(foreseen.functions, false));
    if (!foreseen.values.empty()) sections.push_back(value_section(foreseen.values, false));
  }
  json rows = json::array();
  for (std::size_t n = 0; n < foreseen.order.size(); ++n) {
    const SetUp& s = plan.problem.setups[foreseen.order[n]];
    rows.push_back(json::array({n + 1, s.name, kKindNames.at(static_cast<std::size_t>(s.kind)),
                                s.q.size(), kUmPerMm * foreseen.rms_u[n]}));
  }
  sections.push_back(table_section("Set-ups, each adding most to those before",
                                   {plain_column(""), plain_column("set-up"), plain_column("kind"),
                                    plain_column("observations"), column("u left, rms", "µm", 2)},
                                   rows));
  std::vector<std::string> lines;
  for (const std::string& sphere : plan.unreached)
    lines.push_back("out of reach, left out: " + sphere);
  lines.push_back(fmt::format("{} rows, {} unknowns", foreseen.rows, foreseen.unknowns));
  if (foreseen.solvable) lines.push_back(volume_line(foreseen.volume));
  sections.push_back(text_section("", lines));
  return text_of_sections(sections);
}

json foreseen_json(const MeasurementPlan& plan, const Foreseen& foreseen) {
  json out = plan_json(plan);
  out["unknowns"] = foreseen.unknowns;
  out["rows"] = foreseen.rows;
  out["solvable"] = foreseen.solvable;
  out["nullity_functions"] = foreseen.rank.nullity_functions;
  out["unseen"] = foreseen.rank.unseen;
  out["together"] = foreseen.rank.together;
  out["functions"] = functions_json(plan, foreseen.functions);
  out["values"] = values_json(foreseen.values);
  out["u_volume"] = foreseen.solvable ? volume_json(foreseen.volume) : json();
  out["order"] = json::array();
  for (std::size_t n = 0; n < foreseen.order.size(); ++n)
    out["order"].push_back({{"setup", plan.problem.setups[foreseen.order[n]].name},
                            {"observations", plan.problem.setups[foreseen.order[n]].q.size()},
                            {"rms_u_um", kUmPerMm * foreseen.rms_u[n]}});
  out["unreached"] = plan.unreached;
  return out;
}

}  // namespace volcomp::host::identify
