#include "host_sim/experiments/face_gear/flank_charts.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/pitch_charts.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

constexpr double kMagnification = 100.0;

std::string flank_title(const FlankMap& flank) {
  return fmt::format("{} flank of slot {}", kFaceSideNames[flank.flank.side > 0 ? 0 : 1],
                     flank.flank.slot + 1);
}

// From the axis of the gear outwards, and from the tip towards the root; rows are drawn as one
// curve with gaps.
json topography_of(const FaceGearResult& run, const FlankMap& flank) {
  json radius = json::array();
  json nominal = json::array();
  json measured = json::array();
  for (std::size_t r = 0; r < kGridRows; ++r) {
    for (std::size_t c = 0; c < kGridColumns; ++c) {
      const Vec3& p = run.grid[r][c].point;
      const double below_tip = run.gear.z_tip - p.z();
      radius.push_back(std::hypot(p.x(), p.y()));
      nominal.push_back(below_tip);
      measured.push_back(flank.map.has(r, c)
                             ? json(below_tip + kMagnification * flank.map.at(r, c) / kUmPerMm)
                             : json(nullptr));
    }
    radius.push_back(radius.back());
    nominal.push_back(nullptr);
    measured.push_back(nullptr);
  }
  return host::lines_chart(
      fmt::format("topography-{}", kFaceSideNames[flank.flank.side > 0 ? 0 : 1]),
      flank_title(flank), host::axis_label("distance from the gear axis", "mm"),
      host::axis_label("height above the tips", "mm"),
      {{{"name", "nominal"}, {"style", "dashed"}, {"x", radius}, {"y", nominal}},
       {{"name", fmt::format("measured, {:g} : 1", kMagnification)},
        {"x", radius},
        {"y", measured}}});
}

json heat_map_of(const FlankMap& flank) {
  json values = json::array();
  for (std::size_t r = 0; r < kGridRows; ++r) {
    json row = json::array();
    for (std::size_t c = 0; c < kGridColumns; ++c)
      row.push_back(flank.map.has(r, c) ? json(flank.map.at(r, c)) : json(nullptr));
    values.push_back(row);
  }
  return {
      {"type", "heatmap"},
      {"id", fmt::format("map-{}", kFaceSideNames[flank.flank.side > 0 ? 0 : 1])},
      {"title", "Error map: " + flank_title(flank)},
      {"x",
       {{"label", "column, 1 = inside"}, {"digits", 0}, {"values", host::counted(kGridColumns)}}},
      {"y", {{"label", "row, 1 = tip"}, {"digits", 0}, {"values", host::counted(kGridRows)}}},
      {"z",
       {{"label", "deviation, + = excess"}, {"unit", "µm"}, {"digits", 1}, {"values", values}}}};
}

}  // namespace

json topography(const FaceGearResult& run, FaceStage stage) {
  json charts = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    charts.push_back(topography_of(run, run.at(stage).maps.at(side)));
  return host::chart_group(
      "topography", "Tooth topography", charts,
      fmt::format("Dashed: the nominal rows of the grid. Deviations are drawn upwards where there "
                  "is excess material, {:g} times as large as they are: 10 µm are {:g} mm of the "
                  "scale. Frame solved, machine compensated.",
                  kMagnification, kMagnification * 10.0 / kUmPerMm));
}

json flank_maps(const FaceGearResult& run, FaceStage stage) {
  json maps = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    maps.push_back(heat_map_of(run.at(stage).maps.at(side)));
  return maps;
}

json single_pitch_bars(const FaceGearResult& run, std::size_t side) {
  const FacePitch& pitch = run.at(FaceStage::compensated).pitch.at(side);
  return host::single_pitch_chart(
      kFaceSideNames[side], {{"compensated", pitch.position}},
      fmt::format("Largest {:.1f} µm; F_p {:.1f} µm, F_p over {} pitches {:.1f} µm.",
                  pitch.figures.single, pitch.figures.total, kPitchSpan, pitch.over_10));
}

json pitch_curves(const FaceGearResult& run) {
  json charts = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side) {
    std::vector<host::PitchCurve> curves;
    for (std::size_t s = 0; s < kFaceStages.size(); ++s)
      curves.push_back({kFaceStages.at(s), run.inspection.at(s).pitch[side].position});
    curves.push_back({"the gear itself", run.true_pitch[side].position, true});
    charts.push_back(host::cumulative_pitch_chart(kFaceSideNames[side], curves));
  }
  return host::chart_group("pitch", "Cumulative pitch of all teeth", charts,
                           "F_p is the height of a curve. A gear out of centre shows as a wave "
                           "until the frame is solved.");
}

}  // namespace volcomp::face_gear
