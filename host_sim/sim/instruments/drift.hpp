#pragma once
// Drift of an instrument or a set-up with time.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volcomp::sim {

enum class DriftKind : std::uint8_t {
  walk,         // `size` per √s, from 0 on
  ornstein,     // about 0 with the standard deviation `size`, forgotten with `tau`: air, clamping
  exponential,  // towards `size` with `tau`: warm-up
};

struct Drift {
  DriftKind kind = DriftKind::ornstein;
  double size = 0.0;   // mm, ≥ 0
  double tau = 900.0;  // s, > 0

  // At the instants `time`, ascending, s; `z`: a standard normal number each.
  [[nodiscard]] std::vector<double> at(const std::vector<double>& time,
                                       const std::vector<double>& z) const {
    std::vector<double> drift(time.size());
    for (std::size_t k = 0; k < time.size(); ++k) {
      const double before = k > 0 ? drift[k - 1] : 0.0;
      const double gone = k > 0 ? time[k] - time[k - 1] : 0.0;
      drift[k] = next(before, gone, time[k] - time[0], z[k], k == 0);
    }
    return drift;
  }

 private:
  [[nodiscard]] double next(double before, double gone, double since_start, double z,
                            bool first) const {
    switch (kind) {
      case DriftKind::walk:
        return before + size * std::sqrt(gone) * z;
      case DriftKind::ornstein: {
        const double kept = first ? 0.0 : std::exp(-gone / tau);
        return kept * before + size * std::sqrt(1.0 - kept * kept) * z;
      }
      case DriftKind::exponential:
        break;
    }
    return size * (1.0 - std::exp(-since_start / tau));
  }
};

}  // namespace volcomp::sim
