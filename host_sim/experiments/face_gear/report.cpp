#include "host_sim/experiments/face_gear/report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_gear_grade.hpp"
#include "host_sim/experiments/face_gear/figures.hpp"
#include "host_sim/experiments/face_gear/flank_charts.hpp"
#include "host_sim/experiments/face_gear/published_maps.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

constexpr double kArcSeconds = 3600.0 * host::kDegPerRad;  // in a rad

json stage_table(const FaceGearResult& run) {
  json rows = json::array();
  const auto add = [&](const char* name, const json& map, const std::array<FacePitch, 2>& pitch,
                       const std::string& grade) {
    json row = {name, map.value("rms", json()), map.value("max", json())};
    for (const FacePitch& side : pitch) {
      for (const double um : {side.figures.total, side.figures.single, side.over_10})
        row.push_back(um);
    }
    row.push_back(grade);
    rows.push_back(row);
  };
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    const FaceInspection& i = run.inspection.at(s);
    const MapError& map = run.map_error.at(s);
    add(kFaceStages.at(s), {{"rms", map.rms}, {"max", map.max}}, i.pitch, grade_text(i));
  }
  add("the gear itself", json::object(), run.true_pitch, "");
  json columns =
      json::array({host::plain_column("measured with"), host::column("map − gear, rms", "µm", 2),
                   host::column("largest", "µm", 2)});
  for (const char* side : kFaceSideNames) {
    for (const char* figure : {"F_p", "f_pt", "F_p10"})
      columns.push_back(host::column(fmt::format("{} {}", figure, side), "µm", 2));
  }
  columns.push_back(host::plain_column(
      fmt::format("profile, rows {} to {}", kProfileRows.first + 1, kProfileRows.last + 1)));
  return host::in_summary(host::with_id(
      "stages",
      host::table_section("Before and after: frame and volumetric compensation", columns, rows),
      fmt::format("Grades: {}.", kFaceGearLimitsSource)));
}

// Touches that are too far apart are named and count all the same.
std::string outlier_text(const FaceGearResult& run) {
  const double limit_um = kOutlierSigmas * kUmPerMm * scatter_of(run.options).sigma_mm();
  if (run.options.touches < 2 || !(limit_um > 0.0))
    return "outliers: none can be told without several touches of a point that scatter";
  std::string named;
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    for (const OutlierPoint& o : run.inspection.at(s).outliers)
      named += fmt::format("; {}, slot {} {}, row {}, column {}: {:.2f} µm", kFaceStages.at(s),
                           o.flank.slot + 1, kFaceSideNames.at(o.flank.side > 0 ? 0 : 1), o.row + 1,
                           o.column + 1, o.spread_um);
  }
  return fmt::format("outliers, touches of a point more than {:.1f} µm apart: {}", limit_um,
                     named.empty() ? "none" : named.substr(2));
}

// What was found besides maps and pitch, in words.
json found_text(const FaceGearResult& run) {
  const KnownFrame& frame = run.at(FaceStage::compensated).frame;
  const Eigen::Matrix<double, 6, 1> sd = frame_deviations(run.gear, frame.fit->observability);
  const NodeAgreement node = agreement_of(run);
  return host::in_summary(host::with_id(
      "found",
      host::text_section(
          "Gear, frame and touches",
          {fmt::format("gear: {} teeth, module {:g}, shaper of {} teeth; flanks whole outside "
                       "{:.3f} mm, pointed from {:.3f} mm; moment arm of the normals {:.3f} mm",
                       run.gear.teeth, run.gear.module, run.gear.shaper_teeth,
                       run.gear.undercut_radius, run.gear.pointing_radius, run.gear.arm),
           std::isfinite(run.worked_example_deg)
               ? fmt::format("frame angle of the paper's ball: {:.4f} deg", run.worked_example_deg)
               : "frame angle of the paper's ball: it does not touch this gear",
           fmt::format("frame of {} touches: condition {:.1f}; per µm of noise {:.2f} {:.2f} "
                       "{:.2f} µm along, {:.2f} {:.2f} {:.2f} µm about X, Y, Z",
                       frame.touches, frame.fit->observability.condition, sd(0), sd(1), sd(2),
                       sd(3), sd(4), sd(5)),
           fmt::format("scale of the table {:.1f}\", swing arm ±{:.0f} µm; one distance {:.0f} ns",
                       kScaleStep_rad * kArcSeconds, kUmPerMm * kArmRepeatability_mm,
                       run.kernel_ns),
           fmt::format("{} touches judged by the node: distances as here to {} nm, {} other "
                       "verdicts",
                       node.touches, node.largest_nm, node.verdicts),
           scatter_text(run.options), outlier_text(run)})));
}

double largest_over_all_rows() {
  double largest = 0.0;
  for (std::size_t side = 0; side < kFaceSides.size(); ++side) {
    ProfileDeviation profile;
    host::require(
        profile_deviation(published_map(PublishedMap::machine, side), {0, kGridRows - 1}, profile),
        "Tables 5 and 6");
    largest = std::max(largest, profile.value);
  }
  return largest;
}

json statement_table() {
  json rows = json::array();
  for (const PaperStatement& s : paper_statements())
    rows.push_back({s.what, s.stated, s.found});
  return host::with_id(
      "paper",
      host::table_section(
          "What the paper says of its Tables 5 to 8",
          {host::plain_column("largest difference between machine and measuring centre"),
           host::column("stated", "µm", 1), host::column("in the tables", "µm", 1)},
          rows),
      fmt::format("The profile is the largest range of a column over rows {} to {}; over all {} "
                  "rows the largest is {:.1f} µm.",
                  kProfileRows.first + 1, kProfileRows.last + 1, kGridRows,
                  largest_over_all_rows()));
}

std::string published_errors(bool rotary) {
  return rotary ? fmt::format("radial and axial {:g} µm", kUmPerMm * kRunOut_mm)
                : fmt::format("straight to {:g} µm in {:g} mm, square to {:.1f} µrad",
                              kUmPerMm * kStraightness_mm, kStraightnessLength_mm,
                              host::kUradPerRad * kSquareness_rad);
}
std::string chosen_errors(bool rotary) {
  return rotary ? fmt::format("position {:g} µrad, tilt as the axial run-out at {:g} mm",
                              host::kUradPerRad * kTablePosition_rad, kTableRim_mm)
                : fmt::format("position {:g} µm, angles {:g} µrad", kUmPerMm * kPositioning_mm,
                              host::kUradPerRad * kSlideAngle_rad);
}

json machine_table(const FaceGearResult& run) {
  json rows = json::array();
  for (const host::AxisFile& axis : run.machine.axes) {
    const double scale = axis.rotary ? host::kDegPerRad : 1.0;
    rows.push_back({std::string(1, axis.letter), scale * axis.lo, scale * axis.hi,
                    axis.rotary ? "deg" : "mm", published_errors(axis.rotary),
                    chosen_errors(axis.rotary)});
  }
  const Vec3 off = kUmPerMm * (true_mounting().t - nominal_mounting().t);
  const Mat3 rotation = nominal_mounting().R.transpose() * true_mounting().R;
  return host::with_id(
      "machine",
      host::table_section(
          "The machine: its errors as far as published, the rest chosen",
          {host::plain_column("axis"), host::column("from", "", 0), host::column("to", "", 0),
           host::plain_column("unit"), host::plain_column("at the limits published"),
           host::plain_column("amplitudes chosen")},
          rows),
      fmt::format(
          "Z is parallel to the axis of C within {:g} µrad, as published. Neither chain nor "
          "strokes of the YK7280 are: they are chosen. The gear lies {:.1f}, {:.1f}, {:.1f} µm out "
          "of place "
          "and {:.1f}' turned; steps of the table's scale {:.1f}\", swing arm within {:g} "
          "µm.",
          host::kUradPerRad * kParallelism_rad, off.x(), off.y(), off.z(),
          kArcSeconds / 60.0 * std::abs(std::atan2(rotation(1, 0), rotation(0, 0))),
          kArcSeconds * kScaleStep_rad, kUmPerMm * kArmRepeatability_mm));
}

json before_after(const FaceGearResult& run) {
  const FaceInspection& before = run.at(FaceStage::one_ball);
  const FaceInspection& after = run.at(FaceStage::compensated);
  std::vector<host::BeforeAfter> lines{
      {"error map from the gear, rms", run.map_error.front().rms, run.map_error.back().rms},
      {"error map from the gear, largest", run.map_error.front().max, run.map_error.back().max}};
  for (std::size_t side = 0; side < kFaceSides.size(); ++side) {
    const PitchDeviations& truth = run.true_pitch[side].figures;
    lines.push_back({fmt::format("pitch F_p, {} flanks", kFaceSideNames[side]),
                     before.pitch[side].figures.total, after.pitch[side].figures.total,
                     truth.total});
    lines.push_back({fmt::format("pitch f_pt, {} flanks", kFaceSideNames[side]),
                     before.pitch[side].figures.single, after.pitch[side].figures.single,
                     truth.single});
  }
  return host::before_after_table(
      lines,
      fmt::format("Before: the frame of the gear from one ball as in the "
                  "paper, nothing compensated. After: the frame of {} "
                  "touches, the machine compensated.",
                  after.frame.touches),
      0);
}

host::Origins origins(const FaceGearResult& run) {
  const FaceGearOptions& o = run.options;
  host::Origins origins;
  origins.settings = {{"gear", o.gear},
                      {"form of the flanks", kFormTruths.at(static_cast<std::size_t>(o.form))},
                      {"seed", fmt::format("{} (errors of machine and gear, scatter)", o.seed)}};
  origins.inputs = run.inputs;
  origins.instruments = {
      "touch probe of the machine: delays and radius of the machine file, corrected by the node",
      scatter_text(o),
      fmt::format("table: steps of its scale {:.1f}\"; swing arm repeats within {:g} µm",
                  kArcSeconds * kScaleStep_rad, kUmPerMm * kArmRepeatability_mm)};
  origins.chosen = {kChosenText};
  origins.untouched = {"maps, pitch and frame as measured"};
  return origins;
}

}  // namespace

json face_gear_document(const FaceGearResult& result, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "YK7280: a face gear measured on its machine";
  parts.subtitle = fmt::format(
      "{} teeth, module {:g}, shaper of {} teeth; every touch through drives, bus and node",
      result.gear.teeth, result.gear.module, result.gear.shaper_teeth);
  parts.verdict = face_gear_verdict(result);
  parts.before_after = before_after(result);
  parts.plots.push_back(topography(result, FaceStage::compensated));
  for (json& map : flank_maps(result, FaceStage::compensated))
    parts.plots.push_back(std::move(map));
  parts.plots.push_back(pitch_curves(result));
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    parts.plots.push_back(single_pitch_bars(result, side));
  parts.details = {stage_table(result), found_text(result), statement_table(),
                   machine_table(result)};
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(result));
  return host::report_document(std::move(parts));
}

std::string face_gear_summary(const FaceGearResult& result) {
  return host::terminal_text(face_gear_document(result, {}));
}

}  // namespace volcomp::face_gear
