#pragma once
// An external involute gear as a TOML file:
//
//   teeth = 31
//   module_mm = 4.0             # normal
//   pressure_angle_deg = 20.0   # normal
//   helix_angle_deg = 0.0       # positive: right hand; default 0
//   tip_diameter_mm = 132.0
//   width_mm = 30.0

#include <filesystem>
#include <string>

#include "comp/metrology/gears/involute_gear.hpp"

namespace volcomp::host {

// Both throw UserError naming file, line and field.
[[nodiscard]] InvoluteGear parse_involute_gear(const std::string& text, const std::string& name);
[[nodiscard]] InvoluteGear read_involute_gear(const std::filesystem::path& path);

}  // namespace volcomp::host
