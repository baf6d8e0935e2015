#pragma once
// A grade with everything that decided it, so that it can be checked: edition, row, rounding.
// No edition reproduces all grades of the paper of docs/papers/internal-helical.md, and a grade
// without provenance hides which one was used.

#include "comp/metrology/gears/gear_tolerance.hpp"

namespace volcomp {

enum class LimitRounding : unsigned char { rounded, unrounded };

struct GearGrade {
  GearStandard standard = GearStandard::iso1328_1995;
  LimitRounding rounding = LimitRounding::rounded;
  GearDeviation deviation = GearDeviation::single_pitch;
  GearSize size{};
  GearRow row{};  // of the 1995 tables; the edition of 2013 has none
  double value_um = 0.0;
  std::optional<int> grade;  // none: worse than the last
};

// Refused: not_finite, no_deviation (value) for a value that is not above 0, out_of_standard
// (field, value).
Status grade_gear(GearStandard standard, LimitRounding rounding, const GearSize& size,
                  GearDeviation deviation, double value_um, GearGrade& out);

}  // namespace volcomp
