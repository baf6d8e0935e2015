#pragma once
// Compares the uncertainty of a number with a standard deviation written down by hand.

#include <string>

#include <gtest/gtest.h>

#include "host_sim/host/measure/whole_way/whole_way.hpp"

namespace volcomp::host {

inline void no_progress(double /*done*/, const std::string& /*what*/) {}

[[nodiscard]] inline WholeWaySettings with_draws(std::size_t draws) {
  WholeWaySettings settings;
  settings.draws = draws;
  settings.threads = 2;
  return settings;
}

// Both ways of computing it: by first order within `relative`, by draws as far as their number
// allows. `products` of two small numbers, mm, are in neither.
inline void expect_deviation(const DrawnNumber& n, double deviation, std::size_t draws,
                             double relative = 1e-6, double products = 1e-12) {
  ASSERT_TRUE(n.first_order.has_value());
  EXPECT_NEAR(*n.first_order, deviation, relative * deviation + products);
  EXPECT_NEAR(n.deviation, deviation,
              (TaskUncertainty::ratio_band(draws) + relative) * deviation + products);
}

}  // namespace volcomp::host
