#pragma once
// Checks of entered parameters against wrong units.

#include <array>

#include "comp/core/status.hpp"
#include "comp/machine/machine_limits.hpp"

namespace volcomp {

// Squareness parameters: finite and at most 5 mrad, else not_finite or unit_suspected (arc seconds)
// with where.field = `field` and where.index.
Status check_squareness(const char* field, const std::array<double, 3>& values);

// An arm or offset: finite, at most 5 m, and not all components below 1 mm unless all are 0
// (metres).
Status check_offset(const char* field, const std::array<double, 3>& values);

// A length that must be positive, mm: a limit or a rate.
Status check_positive(const char* field, double value);

}  // namespace volcomp
