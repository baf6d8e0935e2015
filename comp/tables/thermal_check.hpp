#pragma once
// Checks which expansions, reference temperatures and expiries can be used: for images, whose check
// names no field (flash of small boards), and for check_expansion and check_validity, which do.

#include <cmath>

#include "comp/tables/machine_tables.hpp"

namespace volcomp {

inline bool usable_growth(const AxisExpansion& e, const Joint& joint) {
  return std::abs(e.per_K) <= (joint.kind == JointKind::prismatic ? kMaxExpansion_per_K : 0.0F);
}

inline bool usable_fixed_point(const AxisExpansion& e) {
  return std::abs(e.fixed_mm) <= kMaxFixed_mm;
}

inline bool usable_input(const AxisExpansion& e) {
  return e.input < kTemperatureInputs || e.input == kNoTemperature;
}

inline bool usable(const AxisExpansion& e, const Joint& joint) {
  return usable_growth(e, joint) && usable_fixed_point(e) && usable_input(e);
}

inline bool usable_expiry(const Provenance& p) { return p.expires_unix_s >= 0; }

inline bool usable(const Provenance& p) {
  return is_temperature(p.temperature_C) && usable_expiry(p);
}

}  // namespace volcomp
