#pragma once
// Tolerances and grades of cylindrical gears, µm.
//
// The formulas, rows and rounding of both editions agree with independent public implementations;
// the printed standards were not at hand (docs/papers/l300g.md, "What stays open").

#include <array>
#include <optional>

#include "comp/core/status.hpp"

namespace volcomp {

enum class GearStandard : unsigned char {
  iso1328_1995,  // ISO 1328-1:1995 and GB/T 10095.1-2008, grades 0…12
  iso1328_2013,  // ISO 1328-1:2013, classes 1…11
};

enum class GearDeviation : unsigned char {
  single_pitch,   // f_pt
  total_pitch,    // F_p
  profile,        // F_α
  profile_form,   // f_fα
  profile_slope,  // f_Hα
  lead,           // F_β
  lead_form,      // f_fβ
  lead_slope,     // f_Hβ
  runout,         // F_r
};
inline constexpr std::size_t kGearDeviations = 9;

struct GearSize {
  double diameter = 0.0;  // reference, mm
  double module = 0.0;    // normal, mm
  double width = 0.0;     // mm
};

struct GearLimits {
  std::array<double, kGearDeviations> exact{};    // before rounding, µm
  std::array<double, kGearDeviations> rounded{};  // as tables print them, µm
};

// The row of the tables of 1995 a gear falls into: above `over` (first row: from it on), up to and
// including `to`, mm.
struct GearRow {
  struct Range {
    double over = 0.0;
    double to = 0.0;
  };
  Range diameter;
  Range module;
  Range width;
};
[[nodiscard]] GearRow gear_row(const GearSize& size);

[[nodiscard]] int first_grade(GearStandard standard);
[[nodiscard]] int last_grade(GearStandard standard);

// Whether the edition covers a gear of this size. out_of_standard with field and value.
Status check_size(GearStandard standard, const GearSize& size);

// `grade` within first_grade…last_grade; sizes beyond the tables take their first or last row.
[[nodiscard]] GearLimits gear_limits(GearStandard standard, const GearSize& size, int grade);

// The smallest grade whose rounded limit is not exceeded; none when even the last one is.
[[nodiscard]] std::optional<int> grade_of(GearStandard standard, const GearSize& size,
                                          GearDeviation deviation, double value_um);

}  // namespace volcomp
