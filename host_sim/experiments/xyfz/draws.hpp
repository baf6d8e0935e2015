#pragma once
// What is left on PNP after a noisy campaign, and figures of many campaigns.

#include <array>
#include <cstddef>
#include <vector>

namespace volcomp::xyfz {

inline constexpr double kPaperRate = 87.07;  // per cent of the largest deviation on PNP removed

// One campaign and check, PNP.
struct DrawResult {
  double raw_um = 0.0;
  std::array<double, 3> residual_um{};  // naive, abbe, abbe_closed

  [[nodiscard]] double rate(std::size_t model) const;  // per cent
};

// Of at least one value; 0 ≤ fraction ≤ 1, between two values in proportion.
[[nodiscard]] double quantile(std::vector<double> values, double fraction);

// Of the rates of a model over at least one campaign: a quantile, and the share that reaches this.
[[nodiscard]] double rate_quantile(const std::vector<DrawResult>& draws, std::size_t model,
                                   double fraction);
[[nodiscard]] double share_reaching(const std::vector<DrawResult>& draws, std::size_t model,
                                    double wanted);

}  // namespace volcomp::xyfz
