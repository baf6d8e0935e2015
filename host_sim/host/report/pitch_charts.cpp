#include "host_sim/host/report/pitch_charts.hpp"

#include <fmt/format.h>

#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using nlohmann::json;

json single_pitch_chart(const char* side, const std::vector<PitchCurve>& curves,
                        const std::string& note) {
  json bars = json::array();
  for (const PitchCurve& curve : curves) {
    std::vector<double> single(curve.position.size());
    require(single_pitches({curve.position.data(), curve.position.size()},
                           {single.data(), single.size()}),
            "pitch");
    bars.push_back(bars_of(curve.name, single));
  }
  return bar_chart(fmt::format("single-pitch-{}", side),
                   fmt::format("Single pitch, {} flanks", side),
                   counted(curves.front().position.size()), axis_label("f_pt", "µm"), bars, note);
}

json cumulative_pitch_chart(const char* side, const std::vector<PitchCurve>& curves) {
  json series = json::array();
  for (const PitchCurve& curve : curves) {
    series.push_back(series_of(curve.name, counted(curve.position.size()), curve.position));
    if (curve.dashed) series.back()["style"] = "dashed";
  }
  return lines_chart(fmt::format("pitch-{}", side), fmt::format("{} flanks", side),
                     axis_label("slot", ""), axis_label("cumulative pitch deviation", "µm"),
                     series);
}

}  // namespace volcomp::host
