#pragma once
// Classes of touch probes by the names that machine files and options use: one that never errs, a
// strain gauge probe, a kinematic one.

#include <array>

namespace volcomp::host {

inline constexpr std::array<const char*, 3> kProbeClassNames{"none", "rmp600", "lp2"};

}  // namespace volcomp::host
