#pragma once
// Whether readings agree with each other, and which set-up the others do not predict.

#include <optional>
#include <vector>

#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {

struct SetUpCheck {
  std::size_t rows = 0;
  double redundancy = 0.0;         // Σ (1 − leverage)
  double chi2 = 0.0;               // of its readings
  std::optional<double> left_out;  // χ² of all less χ² without it; none: the rest is not enough
  std::optional<Index> left_out_dof;

  // Its readings leave less than a tenth of their stated uncertainty. Ten or more do not by chance
  // (P < 1e-8): a reading or an uncertainty is in another unit.
  [[nodiscard]] bool too_quiet() const;
};

struct Consistency {
  double chi2 = 0.0;
  Index dof = 0;
  double chi2_99 = 0.0;
  std::vector<SetUpCheck> setups;

  [[nodiscard]] bool good() const { return chi2 <= chi2_99; }
};
// `leave_out`: whether every set-up is held against the estimate without it, one solution each.
[[nodiscard]] Consistency check_consistency(const Equations& equations, const Solution& solution,
                                            bool leave_out = true);

// 99 % point of chi-square, after Wilson and Hilferty.
[[nodiscard]] double chi2_limit_99(double dof);

}  // namespace volcomp::host::identify
