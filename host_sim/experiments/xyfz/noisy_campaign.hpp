#pragma once
// A campaign on the simulated machine, and its PNP measured again with what the campaign gave.

#include "host_sim/experiments/xyfz/bench.hpp"

namespace volcomp::xyfz {

inline constexpr std::array<host::ModelKind, 3> kModels{
    host::ModelKind::naive, host::ModelKind::abbe, host::ModelKind::abbe_closed};

// The runs are written to files in this folder and read back, as with a user's own data.
[[nodiscard]] sim::Campaign through_files(const sim::Campaign& campaign,
                                          const std::filesystem::path& folder);

// What a campaign leaves behind, and how PNP is measured after it.
struct CheckedCampaign {
  sim::Campaign campaign;
  sim::TrueMachine at_check;  // as warm as it is then
  sim::InterferometerSetup interferometer;
  sim::Random random;  // of the readings along PNP

  // Such a reading, with these tables; none: uncompensated.
  [[nodiscard]] sim::MeasuredDiagonal pnp(const Bench& bench,
                                          const std::vector<std::uint8_t>& image);
};

// Number `draw` of options.seed. Its random numbers depend on these two alone.
[[nodiscard]] CheckedCampaign noisy_campaign(const Bench& bench,
                                             const std::filesystem::path& folder, std::size_t draw);
[[nodiscard]] CheckedCampaign noise_free_campaign(const Bench& bench,
                                                  const std::filesystem::path& folder);

// PNP with none and with each of the models, by a machine that moves.
struct Compensated {
  DrawResult pnp;
  std::unique_ptr<host::BuiltTables> closed;
};
[[nodiscard]] Compensated compensate(const Bench& bench, CheckedCampaign& measured);

}  // namespace volcomp::xyfz
