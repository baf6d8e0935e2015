#include "comp/metrology/gears/gear_grade.hpp"

#include <cmath>

namespace volcomp {
namespace {

std::optional<int> unrounded_grade(GearStandard standard, const GearSize& size,
                                   GearDeviation deviation, double value_um) {
  for (int grade = first_grade(standard); grade <= last_grade(standard); ++grade) {
    const GearLimits limits = gear_limits(standard, size, grade);
    if (value_um <= limits.exact[static_cast<std::size_t>(deviation)]) return grade;
  }
  return std::nullopt;
}

}  // namespace

Status grade_gear(GearStandard standard, LimitRounding rounding, const GearSize& size,
                  GearDeviation deviation, double value_um, GearGrade& out) {
  Where where;
  where.value = value_um;
  where.has_value = true;
  if (!std::isfinite(value_um)) return refuse(Reason::not_finite, where);
  if (!(value_um > 0.0)) return refuse(Reason::no_deviation, where);
  if (const Status s = check_size(standard, size); !s.ok()) return s;
  const bool as_printed = rounding == LimitRounding::rounded;
  out = {standard,
         rounding,
         deviation,
         size,
         gear_row(size),
         value_um,
         as_printed ? grade_of(standard, size, deviation, value_um)
                    : unrounded_grade(standard, size, deviation, value_um)};
  return {};
}

}  // namespace volcomp
