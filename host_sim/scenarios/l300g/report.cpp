#include "host_sim/scenarios/l300g/report.hpp"

#include <array>

#include <fmt/format.h>

#include "comp/units.hpp"
#include "host_sim/scenarios/l300g/figures.hpp"
#include "host_sim/scenarios/l300g/gear_charts.hpp"
#include "host_sim/scenarios/report_parts.hpp"
#include "host_sim/version.hpp"

namespace volcomp::sim {
namespace {

using nlohmann::json;

constexpr double kDegPerRad = 180.0 / kPi;
constexpr double kCoverage = 2.0;  // of the bands

// --- probe

json residual_chart(const MandrelCalibration& c) {
  std::array<std::vector<double>, 2> y;
  std::array<std::vector<double>, 2> residual;
  for (std::size_t i = 0; i < c.y.size(); ++i) {
    const std::size_t below = c.z[i] > c.fit.geometric.z ? 0 : 1;
    y[below].push_back(c.y[i]);
    residual[below].push_back(kUmPerMm * c.residual(i));
  }
  const auto points = [&](const char* name, std::size_t below) {
    json series = series_of(name, y[below], residual[below]);
    series["style"] = "points";
    return series;
  };
  return {
      {"type", "lines"},
      {"id", "residuals"},
      {"title", "Probe calibration: residuals on the mandrel"},
      {"x", axis_label("Y", "mm")},
      {"y", axis_label("distance from the circle", "µm")},
      {"series", {points("above the mandrel", 0), points("below the mandrel", 1)}},
      {"note",
       fmt::format("{} touches in one half plane, nothing compensated. R_c {:.4f} mm, r_c = R_c "
                   "- R = {:.4f} mm, Y0 {:.4f} mm, Z0 {:.4f} mm, rms {:.2f} µm.",
                   c.y.size(), c.fit.geometric.radius, c.rc, c.fit.geometric.y, c.fit.geometric.z,
                   kUmPerMm * c.fit.rms)}};
}

json effect_row(const std::string& what, const MandrelEffect& e) {
  return {what, kUmPerMm * e.radius, kUmPerMm * e.y0, kUmPerMm * e.z0, kUmPerMm * e.rms};
}

json sensitivities(const L300gResult& r) {
  json rows = json::array();
  rows.push_back(effect_row(fmt::format("arm believed {:g} µm too long", kUmPerMm * kLongerArm_mm),
                            r.longer_arm));
  for (std::size_t i = 0; i < kHigherPivots_mm.size(); ++i)
    rows.push_back(
        effect_row(fmt::format("pivot {:g} mm above the axis of A, ignored", kHigherPivots_mm[i]),
                   r.higher_pivot[i]));
  return {
      {"type", "table"},
      {"id", "sensitivities"},
      {"title", "What the calibration cannot tell from the radius"},
      {"columns",
       {{{"title", "machine"}},
        column("R_c", "µm", 3),
        column("Y0", "µm", 3),
        column("Z0", "µm", 3),
        column("rms", "µm", 4)}},
      {"rows", rows},
      {"note", fmt::format("The residuals hardly show them. Standard uncertainty of r_c with the "
                           "assumed inputs: {:.2f} µm.",
                           kUmPerMm * r.calibration.u_rc)}};
}

// --- identification

json function_chart(const L300gResult& r, std::size_t a, bool angles) {
  const IdentifiedAxis& axis = r.identification.axis[a];
  const bool rotary = r.machine.axes[a].rotary;
  const double scale = angles ? kUradPerRad : kUmPerMm;
  std::vector<double> x;
  for (const double q : axis.nodes)
    x.push_back(rotary ? kDegPerRad * q : q);
  json series = json::array();
  for (Eigen::Index c = angles ? 3 : 0; c < (angles ? 6 : 3); ++c) {
    const double half = kCoverage * scale * r.identification.spread(c);
    std::vector<double> y;
    std::vector<double> low;
    std::vector<double> high;
    for (const ErrorMotion& e : axis.motion) {
      y.push_back(scale * e(c));
      low.push_back(y.back() - half);
      high.push_back(y.back() + half);
    }
    json one = series_of(kChannels[static_cast<std::size_t>(c)], x, y);
    one["band"] = {{"lo", low}, {"hi", high}};
    series.push_back(one);
  }
  return {{"type", "lines"},
          {"id", fmt::format("function-{}-{}", axis.letter, angles ? "angles" : "lengths")},
          {"title", fmt::format("{}: {}", axis.letter, angles ? "angles" : "displacements")},
          {"x", axis_label("position", rotary ? "deg" : "mm")},
          {"y", axis_label("error", angles ? "µrad" : "µm")},
          {"series", series}};
}

json error_functions(const L300gResult& r) {
  json charts = json::array();
  for (std::size_t a = 0; a < r.identification.axis.size(); ++a) {
    charts.push_back(function_chart(r, a, false));
    charts.push_back(function_chart(r, a, true));
  }
  return {
      {"type", "group"},
      {"id", "functions"},
      {"title", "The 24 identified error functions"},
      {"charts", charts},
      {"note",
       fmt::format("Motion of the body itself, in its moving frame. Largest difference from the "
                   "simulated truth {:.1e} mm or rad. Bands: ±{:g} standard uncertainties that "
                   "{:g} µm of each target would leave; condition of the targets {:.2f}.",
                   r.identification.max_error(), kCoverage, kUmPerMm * kTracker_mm,
                   r.identification.condition)}};
}

json printed_table(const L300gResult& r) {
  json rows = json::array();
  for (std::size_t a = 0; a < r.identification.axis.size(); ++a) {
    const IdentifiedAxis& axis = r.identification.axis[a];
    const bool rotary = r.machine.axes[a].rotary;
    const double scale = rotary ? kUradPerRad : kUmPerMm;
    const ReadingFigures& own = r.printed.own.at(a);
    rows.push_back({std::string(1, axis.letter), scale * own.mean, scale * own.deviation,
                    scale * own.range, rotary ? "µrad" : "µm"});
  }
  return {{"type", "table"},
          {"id", "printed"},
          {"title", "What the procedure as printed can give"},
          {"columns",
           {{{"title", "axis"}},
            {{"title", "mean reading"}, {"digits", 3}},
            {{"title", "standard deviation"}, {"digits", 3}},
            {{"title", "range"}, {"digits", 3}},
            {{"title", "unit"}}}},
          {"rows", rows},
          {"note",
           fmt::format("Eq. 18 of the paper repeats the same three rows for every station: rank {} "
                       "of 6. Its shortest solution for X is EX {:.4f} µm, EB {:.2e} rad, EC "
                       "{:.2e} rad: the mean reading, and nothing else.",
                       r.printed.x.rank, kUmPerMm * r.printed.x.least(0), r.printed.x.least(4),
                       r.printed.x.least(5))}};
}

// --- points

json feed_chart(const L300gResult& r) {
  const auto points = [&](const char* name, const std::vector<double>& nm) {
    json series = series_of(name, r.feeds.feed_mm_min, nm);
    series["style"] = "points";
    return series;
  };
  return {{"type", "lines"},
          {"id", "feeds"},
          {"title", "The same place at five feeds"},
          {"x", axis_label("feed", "mm/min")},
          {"y", axis_label("normal to the flank, from the mean", "nm")},
          {"series",
           {points("as latched", r.feeds.raw_nm),
            points("corrected by the node", r.feeds.corrected_nm)}},
          {"note", fmt::format("Spread {:.1f} nm as latched, {:.1f} nm corrected for the delays of "
                               "probe and axes.",
                               r.feeds.raw_spread_nm(), r.feeds.corrected_spread_nm())}};
}

json provenance(const L300gResult& r, const std::string& command, const std::string& transport) {
  const L300gOptions& o = r.options;
  return json::array(
      {{"data", "simulated: no machine and no gear was measured"},
       {"command", command},
       {"version", kVersion},
       {"machine file", o.machine.filename().string()},
       {"errors of the machine", o.errors},
       {"path", o.path == PathStyle::fixed_a ? "A stands still, B touches" : "generating"},
       {"origin", o.origin == Origin::nominal ? "machine file" : "fit of the mandrel"},
       {"tables", kTableKinds.at(static_cast<std::size_t>(o.tables))},
       {"seed", std::to_string(o.seed)},
       {"transport", transport}});
}

}  // namespace

json l300g_document(const L300gResult& r, const std::string& command,
                    const std::string& transport) {
  const Verdict verdict = l300g_verdict(r);
  return {{"title", "L300G: gear inspection before and after compensation"},
          {"subtitle",
           "Simulated gear grinder after Yang et al.; every touch through drives, bus and node"},
          {"verdict", {{"ok", verdict.ok}, {"text", verdict.text}}},
          {"provenance", provenance(r, command, transport)},
          {"sections",
           {profile_charts(r), lead_charts(r), gear_table(r), pitch_charts(r),
            residual_chart(r.calibration), sensitivities(r), error_functions(r), printed_table(r),
            feed_chart(r)}}};
}

}  // namespace volcomp::sim
