#include "host_sim/host/measure/gear_choice.hpp"

#include "comp/core/units.hpp"
#include "host_sim/host/io/toml_text.hpp"

namespace volcomp::host {
namespace {

TipRelief read_relief(const TomlSection& s) {
  s.allow_only({"amount_mm", "begin_mm", "length_mm"});
  return {s.number("amount_mm"), s.number("begin_mm"), s.number("length_mm")};
}

FaceGear read_gear(const TomlSection& s) {
  s.allow_only({"shaper_teeth", "teeth", "module_mm", "pressure_angle_deg", "addendum",
                "shaper_addendum", "inside_diameter_mm", "outside_diameter_mm", "relief"});
  FaceGear gear;
  gear.shaper_teeth = static_cast<int>(s.integer("shaper_teeth", 1, kMaxFaceGearTeeth));
  gear.teeth = static_cast<int>(s.integer("teeth", 1, kMaxFaceGearTeeth));
  gear.module = s.number("module_mm");
  gear.pressure_angle = s.number("pressure_angle_deg") * kPi / 180.0;
  gear.addendum = s.number_or("addendum", gear.addendum);
  gear.shaper_addendum = s.number_or("shaper_addendum", gear.shaper_addendum);
  gear.r_in = 0.5 * s.number_or("inside_diameter_mm", 0.0);
  gear.r_out = 0.5 * s.number_or("outside_diameter_mm", 0.0);
  if (s.has("relief")) gear.relief = read_relief(s.table("relief"));
  s.check(derive(gear), "teeth");
  return gear;
}

}  // namespace

FaceGear parse_face_gear(const std::string& text, const std::string& name) {
  return read_toml(text, name, [&](const TomlValue& root) {
    return read_gear(TomlSection(root, name, "the file of the gear"));
  });
}

bool is_published_gear(const std::string& name_or_file) {
  return name_or_file == "table1" || name_or_file == "table3";
}

GearChoice choose_face_gear(const std::string& name_or_file) {
  if (name_or_file == "table3") return {face_gear_of_table_3(), face_grid_of_table_3()};
  const FaceGear gear = name_or_file == "table1"
                            ? face_gear_of_table_1()
                            : parse_face_gear(text_of_file(name_or_file), name_or_file);
  return {gear, plan_face_grid(gear)};
}

}  // namespace volcomp::host
