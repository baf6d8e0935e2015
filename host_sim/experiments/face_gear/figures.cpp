#include "host_sim/experiments/face_gear/figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_gear_grade.hpp"
#include "comp/metrology/faces/map_comparison.hpp"
#include "host_sim/experiments/face_gear/published_maps.hpp"
#include "host_sim/experiments/face_gear/traced_table.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/version.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

// What the frame, encoders and tables of linear segments may leave of a map, rms.
constexpr double kMapAgreement_um = 0.6;

json or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

double largest_in(const MapDifference& difference, bool row, std::size_t number) {
  return row ? difference.row.at(number - 1).largest : difference.column.at(number - 1).largest;
}

double pitch_disagreement_um(const FaceGearResult& run, FaceStage stage) {
  double worst = 0.0;
  for (std::size_t side = 0; side < 2; ++side)
    worst = std::max(worst, std::abs(run.at(stage).pitch[side].figures.total -
                                     run.true_pitch[side].figures.total));
  return worst;
}

json pitch_figures(const FacePitch& pitch) {
  return {{"Fp", pitch.figures.total}, {"fpt", pitch.figures.single}, {"Fpk10", pitch.over_10}};
}

json stage_figures(const FaceGearResult& run, std::size_t stage) {
  const FaceInspection& inspection = run.inspection.at(stage);
  const std::optional<double> profile = worst_profile(inspection);
  json j{{"map", {{"rms_um", run.map_error[stage].rms}, {"max_um", run.map_error[stage].max}}},
         {"pitch",
          {{"left", pitch_figures(inspection.pitch[0])},
           {"right", pitch_figures(inspection.pitch[1])}}},
         {"profile_um", profile ? json(*profile) : json(nullptr)}};
  if (inspection.frame.fit) j["frame"]["rms_um"] = kUmPerMm * inspection.frame.fit->rms;
  return j;
}

json outliers_json(const FaceGearResult& run) {
  json all = json::array();
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    for (const OutlierPoint& o : run.inspection.at(s).outliers)
      all.push_back({{"stage", kFaceStages.at(s)},
                     {"slot", o.flank.slot},
                     {"side", kFaceSideNames.at(o.flank.side > 0 ? 0 : 1)},
                     {"row", o.row + 1},
                     {"column", o.column + 1},
                     {"spread_um", o.spread_um}});
  }
  return all;
}

double scale_step_um(const FaceGearResult& run) {
  return kUmPerMm * kScaleStep_rad * run.gear.r_pitch;
}

// Largest standard deviations of the frame that a probe of 0.5 µm leaves (docs/papers/face-gear.md,
// "Options"), µm; turns at the pitch radius.
json frame_figures(const FaceGearResult& run) {
  const FaceFrame& fit = *run.at(FaceStage::compensated).frame.fit;
  constexpr double kProbe_um = 0.5;
  const Eigen::Matrix<double, 6, 1> sd = kProbe_um * frame_deviations(run.gear, fit.observability);
  return {{"sd_t", sd.head<3>().maxCoeff()},
          {"sd_r", sd.tail<3>().maxCoeff()},
          {"condition", fit.observability.condition},
          {"touches", run.at(FaceStage::compensated).frame.touches}};
}

}  // namespace

std::optional<double> worst_profile(const FaceInspection& inspection) {
  double worst = 0.0;
  for (const FlankMap& flank : inspection.maps) {
    if (!flank.profile) return std::nullopt;
    worst = std::max(worst, *flank.profile);
  }
  return worst;
}

std::string scatter_text(const FaceGearOptions& o) {
  if (o.probe == 0 && !(o.tracer_um > 0.0))
    return "Without scatter: neither probe nor scales of the slides nor tracer have any.";
  const FaceScatter scatter = scatter_of(o);
  const sim::TracedPlan plan = traced_plan(scatter.slide_step_mm);
  const std::string tracer = sim::scatter_text(plan, tracer_of(o));
  return fmt::format(
      "Probe {}: {}; its radius {}; scales of the slides read to {:g} µm: {:.2f} µm (1σ) a touch, "
      "{} touch{} of a point. Tracer that identifies the axes: {}.",
      sim::kProbeClasses.at(o.probe).name, sim::probe_text(sim::kProbeClasses.at(o.probe)),
      o.map_radius ? "mapped on a sphere" : "as the machine file has it",
      kUmPerMm * scatter.slide_step_mm, kUmPerMm * scatter.sigma_mm(), o.touches,
      o.touches == 1 ? "" : "es", tracer);
}

std::vector<PaperStatement> paper_statements() {
  std::array<MapDifference, 2> difference;
  double profile = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const ErrorMap machine = published_map(PublishedMap::machine, side);
    host::require(
        compare_maps(machine, published_map(PublishedMap::centre, side), difference[side]),
        "Tables 5 to 8");
    ProfileDeviation deviation;
    host::require(profile_deviation(machine, kProfileRows, deviation), "Tables 5 and 6");
    profile = std::max(profile, deviation.value);
  }
  const MapDifference& left = difference[0];
  const MapDifference& right = difference[1];
  return {{"left_row2", "left flank, row 2", 3.0, largest_in(left, true, 2)},
          {"left_row5", "left flank, row 5", 4.5, largest_in(left, true, 5)},
          {"right_row2", "right flank, row 2", 2.8, largest_in(right, true, 2)},
          {"right_row5", "right flank, row 5", 4.5, largest_in(right, true, 5)},
          {"left_col5", "left flank, column 5", 4.6, largest_in(left, false, 5)},
          {"left_col10", "left flank, column 10", 2.4, largest_in(left, false, 10)},
          {"right_col5", "right flank, column 5", 3.0, largest_in(right, false, 5)},
          {"right_col10", "right flank, column 10", 2.2, largest_in(right, false, 10)},
          {"largest", "largest difference of all", 5.0,
           std::max(left.overall.largest, right.overall.largest)},
          {"profile", "profile on the machine, rows 2 to 6", 5.8, profile}};
}

NodeAgreement agreement_of(const FaceGearResult& run) {
  NodeAgreement all;
  for (const FaceInspection& inspection : run.inspection) {
    all.touches += inspection.node.touches;
    all.verdicts += inspection.node.verdicts;
    all.largest_nm = std::max(all.largest_nm, inspection.node.largest_nm);
  }
  return all;
}

std::string grade_text(const FaceInspection& inspection) {
  const std::optional<double> profile = worst_profile(inspection);
  if (!profile) return "no grade: cells of the map are missing";
  const std::optional<int> grade = face_gear_grade(*profile);
  const int last = kFaceGearLimits.back().grade;
  return fmt::format("{:.1f} µm, {}", *profile,
                     grade ? fmt::format("grade {}", *grade) : fmt::format("worse than {}", last));
}

// The centre that is subtracted from a map scatters, too: of two flanks the sum of scatter, rms, is
// more than twice that of a point once in 20 times (e⁻³: chi-square of two degrees beyond 6).
FaceLimits limits_of(const FaceGearResult& run) {
  const double point =
      kUmPerMm * scatter_of(run.options).sigma_mm() / std::sqrt(run.options.touches);
  FaceLimits limits;
  limits.scatter = 2.0 * point;
  limits.map = std::hypot(kMapAgreement_um, limits.scatter);
  // Of the highest tooth and of the lowest: a step of the scale, and 2σ.
  limits.pitch = 2.0 * (scale_step_um(run) + 2.0 * point);
  return limits;
}

host::Verdict face_gear_verdict(const FaceGearResult& run) {
  const MapError& one = run.map_error[0];
  const MapError& frame = run.map_error[1];
  const MapError& all = run.map_error[2];
  const double pitch = pitch_disagreement_um(run, FaceStage::compensated);
  const FaceLimits limits = limits_of(run);
  host::Verdict v;
  const NodeAgreement node = agreement_of(run);
  v.ok = node.largest_nm <= 1 && node.verdicts == 0 && all.rms <= limits.map &&
         all.rms <= std::hypot(std::min(one.rms, frame.rms), limits.scatter) &&
         pitch <= limits.pitch;
  v.text = fmt::format(
      "Maps are {:.2f} µm rms from the gear with the frame of one ball, {:.2f} with that of {} "
      "touches, {:.2f} with the machine compensated as well (limit {:.2f}); F_p then differs by "
      "{:.1f} µm from that of the gear, of which scale of the table and probe may be {:.1f}.",
      one.rms, frame.rms, run.at(FaceStage::frame).frame.touches, all.rms, limits.map, pitch,
      limits.pitch);
  return v;
}

json face_gear_figures(const FaceGearResult& run) {
  json j = stage_figures(run, static_cast<std::size_t>(FaceStage::compensated));
  j["frame"] = frame_figures(run);
  j["frame_angle_deg"] = or_null(run.worked_example_deg);
  for (const PaperStatement& s : paper_statements())
    j["paper"][s.key] = s.found;
  for (std::size_t s = 0; s < kFaceStages.size(); ++s)
    j["stages"].push_back(stage_figures(run, s));
  j["truth"]["pitch"] = {{"left", pitch_figures(run.true_pitch[0])},
                         {"right", pitch_figures(run.true_pitch[1])}};
  j["kernel_ns"] = run.kernel_ns;
  const NodeAgreement node = agreement_of(run);
  j["node_touches"] = node.touches;
  j["node_agreement_nm"] = node.largest_nm;
  j["node_other_verdicts"] = node.verdicts;
  j["gear"] = run.options.gear;
  j["probe"] = sim::kProbeClasses.at(run.options.probe).name;
  j["touches"] = run.options.touches;
  j["tracer_um"] = run.options.tracer_um;
  j["identify"] = {{"largest_um", kUmPerMm * run.identification.largest_mm},
                   {"rms_um", kUmPerMm * run.identification.rms_mm},
                   {"u_rms_um", kUmPerMm * run.identification.u_rms_mm},
                   {"chi2_over_dof", run.identification.chi2_over_dof}};
  j["outliers"] = outliers_json(run);
  j["form"] = kFormTruths.at(static_cast<std::size_t>(run.options.form));
  j["seed"] = run.options.seed;
  j["version"] = host::kVersion;
  return j;
}

}  // namespace volcomp::face_gear
