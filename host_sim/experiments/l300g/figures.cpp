#include "host_sim/experiments/l300g/figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

// Allowed difference of the total deviations from those of the gear: what tables of linear segments
// leave of waves of 0.4 µm, and some room (docs/papers/l300g.md, "Options").
constexpr double kAgreement_um = 0.4;
// What splines leave anywhere in the travels of waves of 0.4 µm and 7 µrad, and some room. Of
// constants and slopes they leave less than a nanometre.
constexpr double kIdentified_mm = 0.25e-3;
constexpr double kFeedSpread_nm = 10.0;
constexpr double kLobing_um = 0.2;

json or_null(const std::optional<int>& grade) { return grade ? json(*grade) : json(nullptr); }

// Of the worst tooth; F also as the mean of the teeth and of their mean trace.
json trace_figures(const host::FlankTrace& trace, const SeveralTeeth& teeth) {
  return {{"F", trace.figures.total},
          {"F_mean", teeth.mean},
          {"F_of_mean_trace", teeth.of_mean_trace},
          {"ff", trace.figures.form},
          {"fH", trace.figures.slope},
          {"grade1995", or_null(trace.grade_1995)},
          {"grade2013", or_null(trace.grade_2013)}};
}

json gear_figures(const L300gResult& r) {
  json j;
  std::vector<std::pair<const char*, const GearInspection*>> found{{"before", &r.before},
                                                                   {"after", &r.after}};
  if (r.on_centre) found.emplace_back("on_centre", &*r.on_centre);
  for (const auto& [when, gear] : found) {
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      const char* const name = kSideNames[side];
      j["profile"][when][name] = trace_figures(gear->profile[side], gear->profile_teeth[side]);
      j["lead"][when][name] = trace_figures(gear->lead[side], gear->lead_teeth[side]);
      j["pitch"][when][name] = {{"Fp", gear->pitch[side].figures.total},
                                {"fpt", gear->pitch[side].figures.single}};
    }
  }
  return j;
}

// Largest difference of the total deviations from those of the gear.
double disagreement_um(const GearInspection& found, const GearInspection& truth) {
  double worst = 0.0;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const auto differ = [&worst](double a, double b) { worst = std::max(worst, std::abs(a - b)); };
    differ(found.profile[side].figures.total, truth.profile[side].figures.total);
    differ(found.lead[side].figures.total, truth.lead[side].figures.total);
    differ(found.pitch[side].figures.total, truth.pitch[side].figures.total);
  }
  return worst;
}

std::string grades(const std::array<host::FlankTrace, 2>& trace) {
  const auto text = [](const host::FlankTrace& t) {
    return grade_text(t.grade_1995, GearStandard::iso1328_1995);
  };
  const std::string left = text(trace[0]);
  const std::string right = text(trace[1]);
  return left == right ? left : left + "/" + right;
}

// What the machine makes of a gear before it is compensated, on either flank.
struct Picture {
  bool worse = false;
  bool better = false;
};

Picture picture_of(const std::array<host::FlankTrace, 2>& before,
                   const std::array<host::FlankTrace, 2>& itself) {
  Picture p;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const auto number = [side](const std::array<host::FlankTrace, 2>& trace) {
      return trace[side].grade_1995.value_or(last_grade(GearStandard::iso1328_1995) + 1);
    };
    p.worse = p.worse || number(before) > number(itself);
    p.better = p.better || number(before) < number(itself);
  }
  return p;
}

// A probe that scatters makes every total deviation larger: then the grades count.
bool found_as_it_is(const L300gResult& r) {
  if (!r.options.scatters()) return disagreement_um(r.after, r.truth) <= kAgreement_um;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    if (r.after.profile[side].grade_1995 != r.truth.profile[side].grade_1995 ||
        r.after.lead[side].grade_1995 != r.truth.lead[side].grade_1995)
      return false;
  }
  return true;
}

// Single touches at different feeds: a probe that scatters hides what the feed does.
bool feeds_agree(const L300gResult& r) {
  return r.options.probe != 0 || r.feeds.corrected_spread_nm() <= kFeedSpread_nm;
}

// Whether compensation takes a good gear from a bad grade to its own, as the paper reports.
std::string claim(const L300gResult& r, bool found) {
  if (!found && r.options.scatters())
    return "with this scatter the gear does not show its own grades: more touches, a filter, or "
           "a better tracer";
  if (!found)
    return "the tables do not hold what is wrong with this machine: the gear is not found as it is";
  const Picture profile = picture_of(r.before.profile, r.truth.profile);
  const Picture lead = picture_of(r.before.lead, r.truth.lead);
  if (profile.worse && lead.worse) return "profile and lead are put right";
  if (profile.worse)
    return "the paper's claim holds: the profile lost its grade, the lead did not, and it is put "
           "right";
  if (lead.worse) return "the lead lost its grade, the profile did not, and it is put right";
  if (profile.better || lead.better) return "uncompensated the gear looked better than it is";
  return "there was nothing to compensate";
}

}  // namespace

std::string grade_text(const std::optional<int>& grade, GearStandard standard) {
  return grade ? std::to_string(*grade) : fmt::format(">{}", last_grade(standard));
}

host::Verdict l300g_verdict(const L300gResult& r) {
  const bool found = found_as_it_is(r);
  host::Verdict v;
  const bool identified = r.options.scatters() || r.identification.largest_mm <= kIdentified_mm;
  v.ok = found && identified && feeds_agree(r) && r.lobing.corrected_um < kLobing_um;
  v.text = fmt::format(
      "Profile grade {} before, {} after, lead {} before, {} after; of the gear itself {} and {}. "
      "Within {:.2f} µm of the gear: {}.",
      grades(r.before.profile), grades(r.after.profile), grades(r.before.lead),
      grades(r.after.lead), grades(r.truth.profile), grades(r.truth.lead),
      disagreement_um(r.after, r.truth), claim(r, found));
  return v;
}

json l300g_figures(const L300gResult& r) {
  const MandrelCalibration& c = r.calibration;
  json j = gear_figures(r);
  j["probe"] = {{"Rc", c.fit.geometric.radius},
                {"rc", c.rc},
                {"u_rc", c.u_rc},
                {"Y0", c.fit.geometric.y},
                {"Z0", c.fit.geometric.z}};
  j["identify"] = {{"largest_um", kUmPerMm * r.identification.largest_mm},
                   {"rms_um", kUmPerMm * r.identification.rms_mm},
                   {"u_rms_um", kUmPerMm * r.identification.u_rms_mm},
                   {"chi2_over_dof", r.identification.chi2_over_dof},
                   {"readings", r.identification.readings}};
  const Vec3 orientation = host::kUradPerRad * r.orientation;
  j["orientation_urad"] = {orientation.x(), orientation.y(), orientation.z()};
  j["feed_spread_nm"] = {{"raw", r.feeds.raw_spread_nm()},
                         {"corrected", r.feeds.corrected_spread_nm()}};
  j["lobing_um"] = {{"raw", r.lobing.raw_um}, {"corrected", r.lobing.corrected_um}};
  j["errors"] = r.options.errors;
  j["seed"] = r.options.seed;
  j["scatter"] = {{"probe", sim::kProbeClasses.at(r.options.probe).name},
                  {"tracer_um", r.options.tracer_um},
                  {"touches", r.options.rules.touches},
                  {"filter", r.options.rules.filter},
                  {"teeth", r.options.rules.traces.teeth},
                  {"points", r.options.rules.traces.points}};
  j["version"] = host::kVersion;
  return j;
}

}  // namespace volcomp::l300g
