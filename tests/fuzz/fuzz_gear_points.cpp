// Any bytes as points of a gear, and as the file of a gear: accepted or refused with a UserError,
// and what is accepted is graded or refused.

#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_inspection_text.hpp"
#include "host_sim/host/measure/involute_gear_file.hpp"

using volcomp::host::UserError;

namespace {

constexpr const char* kGear =
    "teeth = 31\nmodule_mm = 4.0\npressure_angle_deg = 20.0\nhelix_angle_deg = 15.0\n"
    "tip_diameter_mm = 140.0\nwidth_mm = 30.0\n";

void inspect(const volcomp::InvoluteGear& gear, const std::string& text) {
  std::istringstream stream(text);
  try {
    const auto file = volcomp::host::read_gear_points(stream, "points.csv");
    const auto inspected = volcomp::host::inspect_gear(gear, file);
    std::size_t points = 0;
    for (const auto& trace : inspected.traces)
      points += trace.points;
    if (points != file.points.size()) __builtin_trap();
    static_cast<void>(volcomp::host::inspection_text(gear, inspected));
  } catch (const UserError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  inspect(volcomp::host::parse_involute_gear(kGear, "gear.toml"), text);
  try {
    const auto gear = volcomp::host::parse_involute_gear(text, "gear.toml");
    inspect(gear, "trace,flank,tooth,at [mm],deviation [um]\nlead,left,1,5,1\n");
  } catch (const UserError&) {
    return 0;
  }
  return 0;
}
