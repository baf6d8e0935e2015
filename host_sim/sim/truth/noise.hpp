#pragma once
// Random numbers that are the same on every computer, for what is drawn in a fixed order. Noise of
// readings is a function of what it is for: comp/metrology/statistics/random_stream.hpp.

#include <cmath>
#include <cstdint>
#include <random>

#include "comp/core/units.hpp"

namespace volcomp::sim {

// mt19937_64 is specified to the bit; the distributions of the standard library are not, so they
// are written out.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // 0 ≤ x < 1
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }

  // Box–Muller.
  double normal(double sigma) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return sigma * radius * std::cos(2.0 * kPi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace volcomp::sim
