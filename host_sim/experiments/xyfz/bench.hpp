#pragma once
// The paper's machine as it really is, ready to be measured without and with compensation.

#include "host_sim/experiments/xyfz/scenario.hpp"

namespace volcomp::xyfz {

struct Bench {
  XyfzOptions options;
  host::MachineFile machine;        // with the functional of the noise-free campaign
  host::MachineFile noisy_machine;  // the same with that of the noisy ones
  XyfzTuning tuning;
  sim::TrueMachine truth;
  DiagonalBox box;

  // Both find the tuning of options.machine_seed. Throw UserError.
  Bench(const XyfzOptions& chosen, const host::Progress& progress);
  Bench(const XyfzOptions& chosen, const host::MachineFile& file);
  // For a tuning that is known. Throws UserError.
  Bench(const XyfzOptions& chosen, const host::MachineFile& file, const XyfzTuning& found);

  // What errs in a noisy campaign, and the random numbers of one.
  [[nodiscard]] sim::NoiseClasses noise() const;
  [[nodiscard]] sim::CampaignDraw draw(std::size_t number) const;

  // The machine with these tables, at a corner of its travel; `of` must outlive it.
  [[nodiscard]] std::unique_ptr<sim::MotionCell> cell(const sim::TrueMachine& of,
                                                      const std::vector<std::uint8_t>& image) const;
  // Its diagonal PNP.
  [[nodiscard]] sim::MeasuredDiagonal pnp(const sim::TrueMachine& of,
                                          const std::vector<std::uint8_t>& image,
                                          std::size_t points, const sim::InterferometerSetup& setup,
                                          sim::Random& random) const;
};

}  // namespace volcomp::xyfz
