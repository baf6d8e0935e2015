#pragma once
// The same gear measured many times with a probe that scatters: how far the figures do.

#include "host_sim/experiments/l300g/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/draws_of_run.hpp"

namespace volcomp::l300g {

// One measurement after compensation, by kSides; µm.
struct MeasuredOnce {
  std::array<double, 2> profile{};    // F_α, of the worst tooth
  std::array<double, 2> lead{};       // F_β, likewise
  std::array<double, 2> pitch{};      // F_p
  bool before_worse = false;          // a profile or lead had a worse grade uncompensated
  std::array<bool, 2> own_profile{};  // whether F_α has the grade of the gear
  std::array<bool, 2> own_lead{};     // likewise F_β
  std::array<SeveralTeeth, 2> profile_teeth{};
  std::array<SeveralTeeth, 2> lead_teeth{};
  // By the measuring centre: F_α, then F_β; none: nothing scatters.
  std::optional<std::array<double, 4>> on_centre;

  [[nodiscard]] bool own_grades() const {
    return own_profile[0] && own_profile[1] && own_lead[0] && own_lead[1];
  }
};

struct SpreadResult {
  L300gOptions options;
  nlohmann::json settings;  // all of them, and hashes of the inputs, for programs
  std::vector<host::HashedInput> inputs;
  GearInspection truth;
  std::vector<MeasuredOnce> measurement;  // draws 0, 1, …, or those of a shard

  [[nodiscard]] double share_of_own_grades() const;
};

// A draw is a run of everything, mandrel included, with random numbers of its own. Throws
// UserError.
[[nodiscard]] SpreadResult run_spread(const L300gOptions& options, const host::DrawPlan& plan,
                                      const host::Progress& progress);

// In parts, and of all of them together again.
[[nodiscard]] host::PartialRun part_of_spread(const SpreadResult& result,
                                              const host::DrawPlan& plan);
[[nodiscard]] SpreadResult collect_spread(const host::PartialRun& all);

// Good: profile and lead of both flanks have the grades of the gear in 95 of 100 measurements.
[[nodiscard]] host::Verdict spread_verdict(const SpreadResult& result);
[[nodiscard]] std::string spread_summary(const SpreadResult& result);
[[nodiscard]] nlohmann::json spread_document(const SpreadResult& result,
                                             const host::RunContext& run);
[[nodiscard]] nlohmann::json spread_figures(const SpreadResult& result);

}  // namespace volcomp::l300g
