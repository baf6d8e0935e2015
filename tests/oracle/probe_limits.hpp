#pragma once
// What the settings of a probe may be, by object of the node (docs/object-dictionary.md); the same
// fields stand in volcomp.h. A wrong value is refused through both, a right one by neither.

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::oracle {

struct ProbeSettingCase {
  std::uint16_t index;
  std::uint8_t sub;
  double wrong;
  double right;
  Reason reason;
};

inline std::vector<ProbeSettingCase> probe_setting_cases() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  return {{0x2302, 1, kNan, 2e6, Reason::not_finite},
          {0x2302, 1, -1.0, 0.0, Reason::bad_setting},
          {0x2302, 1, 3e7, 2e7, Reason::bad_setting},
          {0x2302, 16, -1e300, -2e7, Reason::bad_setting},
          {0x2302, 16, kNan, 0.0, Reason::not_finite},
          {0x2303, 1, 0.999, 1.0, Reason::not_a_rotation},
          {0x2303, 5, kNan, 1.0, Reason::not_finite},
          {0x2303, 12, HUGE_VAL, 1e13, Reason::not_finite},
          {0x2303, 12, 1e300, 0.0, Reason::bad_setting},
          {0x2303, 10, -1.1e13, -1e13, Reason::bad_setting},
          {0x2304, 1, 1e300, 1e13, Reason::bad_setting},
          {0x2304, 1, -1.0, 0.0, Reason::bad_setting},
          {0x2304, 2, kNan, 0.0, Reason::not_finite},
          {0x2304, 3, 1.5, 1.0, Reason::bad_setting},
          {0x2304, 3, -1.5, -1.0, Reason::bad_setting},
          {0x2304, 5, -1e-3, 100.0, Reason::bad_setting},
          {0x2304, 7, -1.0, 5e7, Reason::bad_setting},
          {0x2305, 1, kNan, 0.0, Reason::not_finite},
          {0x2305, 5, -2.0, 2.0, Reason::bad_setting},
          {0x2306, 3, kNan, 0.0, Reason::not_finite},
          {0x2306, 3, -1.0, 5e7, Reason::bad_setting}};
}

// Delays, ns: the most that is accepted, and one more, which is not.
inline constexpr std::uint32_t kLongestProbeDelay_ns = 50'000'000;

}  // namespace volcomp::oracle
