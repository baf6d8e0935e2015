#pragma once
// Errors of the simulated L300G: constants, slopes and waves of its 24 error motions, and the
// length of its arm (docs/papers/l300g.md, "Options").

#include <array>
#include <string>

#include "comp/machine/error_motion.hpp"

namespace volcomp::l300g {

inline constexpr std::size_t kGrinderAxes = 4;  // X Y B A

// Body values on the moving side, mm and rad.
struct AxisErrors {
  std::array<double, 6> constant{};
  std::array<double, 6> slope{};  // per mm or rad of travel, zero at 0
  double wave_mm = 0.0;           // amplitude of a sine in each displacement …
  double wave_rad = 0.0;          // … and in each angle, phases from a seed
  double wave_period = 0.0;       // mm or rad

  [[nodiscard]] bool waves() const { return wave_mm > 0.0 || wave_rad > 0.0; }
};

struct GrinderErrors {
  std::array<AxisErrors, kGrinderAxes> axis{};
  double arm_mm = 0.0;  // true length of the arm less that of its file

  [[nodiscard]] bool waves() const;
};

// The errors that have a name.
inline constexpr const char* kNamedErrors = "none, p8, p8-variation, table2, short-arm, a-slope";

[[nodiscard]] bool is_named(const std::string& errors);

// By name, or from a TOML file (README). Throws UserError.
[[nodiscard]] GrinderErrors grinder_errors(const std::string& name_or_file);
[[nodiscard]] GrinderErrors parse_grinder_errors(const std::string& text, const std::string& name);

}  // namespace volcomp::l300g
