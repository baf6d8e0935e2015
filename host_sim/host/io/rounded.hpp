#pragma once
// Numbers as they are printed: -0.0002 with three decimals is 0.000, not -0.000.

#include <cmath>

namespace volcomp::host {

[[nodiscard]] inline double rounded(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(unit * value) / unit + 0.0;  // -0.0 + 0.0 is +0.0
}

}  // namespace volcomp::host
