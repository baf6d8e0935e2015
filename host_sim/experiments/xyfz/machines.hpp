#pragma once
// The same campaigns on many machines: whether what is shown on one of them holds on others. Each
// is tuned to the paper's two raw figures; none is chosen.

#include "host_sim/experiments/xyfz/functionals.hpp"
#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::xyfz {

inline constexpr std::size_t kMostMachines = 1000;

struct StudiedMachine {
  std::uint64_t seed = 0;  // --machine-seed
  XyfzTuning tuning;
  DrawResult noise_free;
  CirclesLessLines functionals;
  std::vector<DrawResult> draws;  // of the shard, in order
};

// NOLINTNEXTLINE(bugprone-exception-escape): nothing in nlohmann::json throws when moved
struct MachinesResult {
  nlohmann::json settings;  // all of them, and hashes of the inputs, for programs
  XyfzOptions options;
  sim::NoiseClasses noise;  // of the noisy campaigns
  std::vector<host::HashedInput> inputs;
  std::vector<StudiedMachine> machine;
  std::vector<std::uint64_t> passed_over;  // seeds between them that cannot show the raw figures

  // Of all machines together, noise-free and with noise.
  [[nodiscard]] std::vector<DrawResult> all_noise_free() const;
  [[nodiscard]] std::vector<DrawResult> all_draws() const;
  [[nodiscard]] std::vector<CirclesLessLines> all_functionals() const;
  // Machines on which the median campaign, or without noise the only one, reaches the paper's rate.
  [[nodiscard]] std::size_t reaching(std::size_t model) const;
};

// options.machines of them from options.machine_seed on, options.draws noisy campaigns on each.
// Campaign d of machine m is number m·draws + d: those of the first machine are those of
// run_xyfz(). The same result for any number of threads. Throws UserError.
[[nodiscard]] MachinesResult run_machines(const XyfzOptions& options,
                                          const host::Progress& progress);

// In parts, and of all of them together again.
[[nodiscard]] host::PartialRun part_of_machines(const MachinesResult& result);
[[nodiscard]] MachinesResult collect_machines(const host::PartialRun& all);

// Good: the median campaign of the closed model reaches the paper's rate on nine machines of ten,
// and on no fewer than that of the paper's own variant.
[[nodiscard]] host::Verdict machines_verdict(const MachinesResult& result);
[[nodiscard]] std::string machines_summary(const MachinesResult& result);
[[nodiscard]] nlohmann::json machines_document(const MachinesResult& result,
                                               const host::RunContext& run);
[[nodiscard]] nlohmann::json machines_figures(const MachinesResult& result);

}  // namespace volcomp::xyfz
