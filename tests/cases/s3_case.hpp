#pragma once
// Shared by the cases of docs/papers/internal-helical.md: gears, wheel setups.

#include "comp/metrology/gears/form_wheel.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

[[nodiscard]] InternalGear internal_gear_of(const json& in);
[[nodiscard]] FlankSide side_of(const json& in);
// `x` and `A` of a case, as they are.
[[nodiscard]] WheelSetup setup_of(const json& in);

}  // namespace volcomp::cases
