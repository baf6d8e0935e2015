#include "host_sim/host/measure/involute_gear_file.hpp"

#include "comp/core/units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/toml_text.hpp"

namespace volcomp::host {
namespace {

InvoluteGear involute_gear(const TomlSection& s) {
  s.allow_only({"teeth", "module_mm", "pressure_angle_deg", "helix_angle_deg", "tip_diameter_mm",
                "width_mm"});
  InvoluteGear gear;
  gear.teeth = static_cast<int>(s.integer("teeth", 5, 1000));
  gear.module = s.number("module_mm");
  gear.pressure_angle = s.number("pressure_angle_deg") * kPi / 180.0;
  gear.helix_angle = s.number_or("helix_angle_deg", 0.0) * kPi / 180.0;
  gear.tip_diameter = s.number("tip_diameter_mm");
  gear.width = s.number("width_mm");
  s.check(derive(gear), "teeth");
  return gear;
}

}  // namespace

InvoluteGear parse_involute_gear(const std::string& text, const std::string& name) {
  return read_toml(text, name, [&](const TomlValue& root) {
    return involute_gear(TomlSection(root, name, "the file of the gear"));
  });
}

InvoluteGear read_involute_gear(const std::filesystem::path& path) {
  return parse_involute_gear(text_of_file(path), shown_name(path));
}

}  // namespace volcomp::host
