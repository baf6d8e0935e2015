#pragma once
// What no measurement and no setting may be.

#include <limits>

namespace volcomp {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace volcomp
