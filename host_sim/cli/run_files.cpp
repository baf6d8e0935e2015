#include "host_sim/cli/run_files.hpp"

#include <algorithm>

#include "host_sim/host/machine/chain_string.hpp"

namespace volcomp::cli {

nlohmann::json run_file_json(const host::RunsFile& runs, const std::string& path) {
  const auto [low, high] = std::minmax_element(runs.positions.begin(), runs.positions.end());
  return {{"axis", std::string(1, runs.letter)},
          {"file", path},
          {"unit", host::is_rotary_letter(runs.letter) ? "rad" : "mm"},
          {"targets", runs.positions.size()},
          {"from", *low},
          {"to", *high},
          {"runs_up", runs.up.size()},
          {"runs_down", runs.down.size()},
          {"rows", runs.positions.size() * (runs.up.size() + runs.down.size())}};
}

nlohmann::json run_values_json() {
  return {{"meaning", "actual - nominal"}, {"length_unit", "mm"}, {"angle_unit", "rad"}};
}

}  // namespace volcomp::cli
