#include "comp/metrology/tables/plausibility.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

Status refuse_field(Reason reason, const char* field, std::size_t index, double value) {
  Where where;
  where.field = field;
  where.index = static_cast<int>(index);
  where.value = value;
  where.has_value = true;
  return refuse(reason, where);
}

}  // namespace

Status check_squareness(const char* field, const std::array<double, 3>& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(values[i])) return refuse_field(Reason::not_finite, field, i, values[i]);
    if (std::abs(values[i]) > kMaxSquareness_rad)
      return refuse_field(Reason::unit_suspected, field, i, values[i]);
  }
  return {};
}

Status check_offset(const char* field, const std::array<double, 3>& values) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(values[i])) return refuse_field(Reason::not_finite, field, i, values[i]);
    if (std::abs(values[i]) > kMaxOffset_mm)
      return refuse_field(Reason::unit_suspected, field, i, values[i]);
    longest = std::max(longest, std::abs(values[i]));
  }
  if (longest > 0.0 && longest < 1.0)
    return refuse_field(Reason::unit_suspected, field, 0, longest);
  return {};
}

Status check_positive(const char* field, double value) {
  if (!std::isfinite(value)) return refuse_field(Reason::not_finite, field, 0, value);
  return value > 0.0 ? Status{} : refuse_field(Reason::bad_setting, field, 0, value);
}

}  // namespace volcomp
