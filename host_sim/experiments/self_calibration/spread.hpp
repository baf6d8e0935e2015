#pragma once
// A plan on many machines: other errors, other noise, other places each time.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/judged_spread.hpp"
#include "host_sim/experiments/self_calibration/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/draws_of_run.hpp"

namespace volcomp::self_calibration {

struct Draw {
  any_machine::JudgedMachine judged;
  VolumeResidual after;
  VolumeResidual predicted;
  double chi2_of_dof = 0.0;
  double coverage = 0.0;  // share of the places within twice their predicted uncertainty
};

// NOLINTNEXTLINE(bugprone-exception-escape): nothing in nlohmann::json throws when moved
struct Spread {
  nlohmann::json settings;               // all of them, and hashes of the inputs, for programs
  Options options;                       // of the first
  std::string machine;                   // its name
  host::identify::MeasurementPlan plan;  // empty where parts were put together
  std::vector<host::HashedInput> inputs;
  std::vector<Draw> drawn;  // seeds options.seed, the next, …, or those of a shard

  [[nodiscard]] std::size_t good() const;
  // Of the places of all machines, and its standard error from machine to machine.
  [[nodiscard]] double coverage() const;
  [[nodiscard]] double coverage_error() const;
};

// Draw i is the machine of seed options.seed + i. Throws UserError.
[[nodiscard]] Spread run_spread(const Options& options, const host::DrawPlan& plan,
                                const host::Progress& progress);

// In parts, and of all of them together again.
[[nodiscard]] host::PartialRun part_of_spread(const Spread& spread, const host::DrawPlan& plan);
[[nodiscard]] Spread collect_spread(const host::PartialRun& all);

// Good: 95 % of the machines are, and 95 % of the places are within twice their uncertainty.
[[nodiscard]] host::Verdict spread_verdict(const Spread& spread);
[[nodiscard]] nlohmann::json spread_document(const Spread& spread, const host::RunContext& run);
[[nodiscard]] std::string spread_summary(const Spread& spread);
[[nodiscard]] nlohmann::json spread_figures(const Spread& spread);

}  // namespace volcomp::self_calibration
