#pragma once
// What the models predict along PNP beside what is measured there (the paper's Fig. 19), and what
// is left when one is subtracted from the other, as the paper does (its Fig. 20).

#include "host_sim/experiments/xyfz/noisy_campaign.hpp"

namespace volcomp::xyfz {

struct Prediction {
  std::vector<double> distance_mm;
  std::vector<double> measured_um;  // mean of both directions, uncompensated, from the first point
  std::array<std::vector<double>, kModels.size()> predicted_um;

  [[nodiscard]] double measured_max_um() const;  // these are magnitudes
  [[nodiscard]] double predicted_max_um(std::size_t model) const;
  [[nodiscard]] double left_um(std::size_t model) const;  // largest of measured less predicted
};

// After a campaign; the reading is the one that run_xyfz() makes first after the same one.
[[nodiscard]] Prediction predict_pnp(const Bench& bench, CheckedCampaign& measured);

}  // namespace volcomp::xyfz
