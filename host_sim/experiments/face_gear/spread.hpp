#pragma once
// Many measurements, each of another machine and gear with scatter of its own: how far the figures
// differ.

#include <array>
#include <string>
#include <vector>

#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/draws_of_run.hpp"

namespace volcomp::face_gear {

// A stage of one measurement, µm.
struct StageOnce {
  MapError map;
  std::array<double, 2> pitch{};  // F_p less that of the gear, left and right
  double profile = 0.0;           // NaN: cells of a map are missing
};

struct MeasuredOnce {
  std::array<StageOnce, 3> stage;  // by FaceStage
  int outliers = 0;                // points whose touches are too far apart
  bool good = false;               // the verdict of this measurement
};

struct SpreadResult {
  FaceGearOptions options;
  nlohmann::json settings;  // all of them, and hashes of the inputs, for programs
  std::vector<host::HashedInput> inputs;
  std::vector<MeasuredOnce> measurement;  // seeds of the options, the next, …, or those of a shard

  [[nodiscard]] std::size_t good() const;
};

// Draw i is a run of everything with the seed of the options + i. Throws UserError.
[[nodiscard]] SpreadResult run_spread(const FaceGearOptions& options, const host::DrawPlan& plan,
                                      const host::Progress& progress);

// In parts, and of all of them together again.
[[nodiscard]] host::PartialRun part_of_spread(const SpreadResult& result,
                                              const host::DrawPlan& plan);
[[nodiscard]] SpreadResult collect_spread(const host::PartialRun& all);

// Good: 15 of 16 measurements have a good verdict of their own.
[[nodiscard]] host::Verdict spread_verdict(const SpreadResult& result);
[[nodiscard]] std::string spread_summary(const SpreadResult& result);
[[nodiscard]] nlohmann::json spread_document(const SpreadResult& result,
                                             const host::RunContext& run);
[[nodiscard]] nlohmann::json spread_figures(const SpreadResult& result);

}  // namespace volcomp::face_gear
