#pragma once
// A figure of a simulation over its draws.

#include <algorithm>
#include <vector>

namespace volcomp::host {

struct RangeOfDraws {
  double median = 0.0;
  double least = 0.0;
  double most = 0.0;
};

// Of one value at least.
[[nodiscard]] inline RangeOfDraws range_of_draws(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

}  // namespace volcomp::host
