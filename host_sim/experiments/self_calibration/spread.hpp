#pragma once
// A plan on many machines: other errors, other noise, other places each time.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/judged_spread.hpp"
#include "host_sim/experiments/self_calibration/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::self_calibration {

struct Draw {
  any_machine::JudgedMachine judged;
  VolumeResidual after;
  VolumeResidual predicted;
  double chi2_of_dof = 0.0;
  double coverage = 0.0;  // share of the places within twice their predicted uncertainty
};

struct Spread {
  Options options;  // of the first
  host::identify::MeasurementPlan plan;
  std::vector<host::HashedInput> inputs;
  std::vector<Draw> drawn;  // seeds options.seed, options.seed + 1, …

  [[nodiscard]] std::size_t good() const;
  // Of the places of all machines, and its standard error from machine to machine.
  [[nodiscard]] double coverage() const;
  [[nodiscard]] double coverage_error() const;
};

// `count` machines on up to `threads` threads; the same result for any number of these. Throws
// UserError.
[[nodiscard]] Spread run_spread(const Options& options, std::size_t count, std::size_t threads,
                                const host::Progress& progress);

// Good: 95 % of the machines are, and 95 % of the places are within twice their uncertainty.
[[nodiscard]] host::Verdict spread_verdict(const Spread& spread);
[[nodiscard]] nlohmann::json spread_document(const Spread& spread, const host::RunContext& run);
[[nodiscard]] std::string spread_summary(const Spread& spread);
[[nodiscard]] nlohmann::json spread_figures(const Spread& spread);

}  // namespace volcomp::self_calibration
