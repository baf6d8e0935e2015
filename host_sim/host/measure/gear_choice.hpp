#pragma once
// Which face gear is measured, and where on its flanks.

#include <string>

#include "comp/metrology/faces/face_grid.hpp"

namespace volcomp::host {

struct GearChoice {
  FaceGear gear;
  FaceGridPlan plan;
};

// "table1" or "table3" of the paper, or a TOML file (README). Throws UserError naming file, line
// and field.
[[nodiscard]] GearChoice choose_face_gear(const std::string& name_or_file);
[[nodiscard]] bool is_published_gear(const std::string& name_or_file);
[[nodiscard]] FaceGear parse_face_gear(const std::string& text, const std::string& name);

}  // namespace volcomp::host
