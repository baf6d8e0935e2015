#include "host_sim/experiments/face_gear/flank_charts.hpp"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/report_parts.hpp"

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
  return {{"type", "lines"},
          {"id", fmt::format("topography-{}", kFaceSideNames[flank.flank.side > 0 ? 0 : 1])},
          {"title", flank_title(flank)},
          {"x", host::axis_label("distance from the gear axis", "mm")},
          {"y", host::axis_label("height above the tips", "mm")},
          {"series",
           {{{"name", "nominal"}, {"style", "dashed"}, {"x", radius}, {"y", nominal}},
            {{"name", fmt::format("measured, {:g} : 1", kMagnification)},
             {"x", radius},
             {"y", measured}}}}};
}

json heat_map_of(const FlankMap& flank) {
  std::vector<int> columns(kGridColumns);
  std::vector<int> rows(kGridRows);
  std::iota(columns.begin(), columns.end(), 1);
  std::iota(rows.begin(), rows.end(), 1);
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
      {"x", {{"label", "column, 1 = inside"}, {"digits", 0}, {"values", columns}}},
      {"y", {{"label", "row, 1 = tip"}, {"digits", 0}, {"values", rows}}},
      {"z",
       {{"label", "deviation, + = excess"}, {"unit", "µm"}, {"digits", 1}, {"values", values}}}};
}

}  // namespace

json topography(const FaceGearResult& run, FaceStage stage) {
  json charts = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    charts.push_back(topography_of(run, run.at(stage).maps.at(side)));
  return {{"type", "group"},
          {"id", "topography"},
          {"title", "Tooth topography"},
          {"shared_y", true},
          {"charts", charts},
          {"note",
           fmt::format("Dashed: the nominal rows of the grid. Deviations are drawn upwards where "
                       "there is excess material, {:g} times as large as they are: 10 µm are {:g} "
                       "mm of the scale. Frame solved, machine compensated.",
                       kMagnification, kMagnification * 10.0 / kUmPerMm)}};
}

json flank_maps(const FaceGearResult& run, FaceStage stage) {
  json maps = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    maps.push_back(heat_map_of(run.at(stage).maps.at(side)));
  return maps;
}

json single_pitch_bars(const FaceGearResult& run, std::size_t side) {
  const std::vector<double>& position = run.at(FaceStage::compensated).pitch.at(side).position;
  std::vector<double> single(position.size());
  host::require(single_pitches({position.data(), position.size()}, {single.data(), single.size()}),
                "pitch");
  std::vector<std::string> teeth;
  for (std::size_t k = 1; k <= position.size(); ++k)
    teeth.push_back(std::to_string(k));
  const PitchDeviations& figures = run.at(FaceStage::compensated).pitch.at(side).figures;
  return {{"type", "bars"},
          {"id", fmt::format("single-pitch-{}", kFaceSideNames[side])},
          {"title", fmt::format("Single pitch, {} flanks", kFaceSideNames[side])},
          {"categories", teeth},
          {"y", host::axis_label("f_pt", "µm")},
          {"series", {{{"name", "compensated"}, {"values", single}}}},
          {"note", fmt::format("Largest {:.1f} µm; F_p {:.1f} µm, F_p over {} pitches {:.1f} µm.",
                               figures.single, figures.total, kPitchSpan,
                               run.at(FaceStage::compensated).pitch.at(side).over_10)}};
}

json pitch_curves(const FaceGearResult& run) {
  json charts = json::array();
  for (std::size_t side = 0; side < kFaceSides.size(); ++side) {
    std::vector<double> tooth(run.true_pitch[side].position.size());
    std::iota(tooth.begin(), tooth.end(), 1.0);
    json series = json::array();
    for (std::size_t s = 0; s < kFaceStages.size(); ++s)
      series.push_back(
          host::series_of(kFaceStages.at(s), tooth, run.inspection.at(s).pitch[side].position));
    json truth = host::series_of("the gear itself", tooth, run.true_pitch[side].position);
    truth["style"] = "dashed";
    series.push_back(truth);
    charts.push_back({{"type", "lines"},
                      {"id", fmt::format("pitch-{}", kFaceSideNames[side])},
                      {"title", fmt::format("{} flanks", kFaceSideNames[side])},
                      {"x", host::axis_label("slot", "")},
                      {"y", host::axis_label("cumulative pitch deviation", "µm")},
                      {"series", series}});
  }
  return {{"type", "group"},
          {"id", "pitch"},
          {"title", "Cumulative pitch of all teeth"},
          {"shared_y", true},
          {"charts", charts},
          {"note",
           "F_p is the height of a curve. A gear out of centre shows as a wave until the frame "
           "is solved."}};
}

}  // namespace volcomp::face_gear
