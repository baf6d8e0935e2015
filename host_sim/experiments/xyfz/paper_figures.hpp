#pragma once
// What the paper shows besides its campaign: readings at several levers (its Figs. 8 and 11), and
// predicted beside measured PNP (Figs. 19 and 20). Without noise and over many draws of it.

#include "host_sim/experiments/xyfz/levers.hpp"
#include "host_sim/experiments/xyfz/prediction.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::xyfz {

struct LeverResult {
  LeverExperiment experiment;
  // By LeverNoise; without noise there is one draw.
  std::array<std::vector<LeverReadings>, kLeverNoises> readings;
};

struct PaperFigures {
  XyfzOptions options;
  XyfzTuning tuning;
  sim::NoiseClasses noise;
  std::vector<host::HashedInput> inputs;
  std::vector<LeverResult> levers;
  Prediction noise_free;
  std::vector<Prediction> prediction;  // by draw
};

// options.draws of noise; 0: none. The same result for any number of threads. Throws UserError.
[[nodiscard]] PaperFigures run_paper_figures(const XyfzOptions& options,
                                             const host::Progress& progress);

// Good: readings carried to one point agree to 0.01 µm without noise and, in the median draw of
// instruments and temperatures, as well as the paper's; without noise the self-test finds the
// levers, and the closed model predicts PNP to 1 µm.
[[nodiscard]] host::Verdict paper_figures_verdict(const PaperFigures& result);
[[nodiscard]] std::string paper_figures_summary(const PaperFigures& result);
[[nodiscard]] nlohmann::json paper_figures_document(const PaperFigures& result,
                                                    const host::RunContext& run);
[[nodiscard]] nlohmann::json paper_figures_json(const PaperFigures& result);

}  // namespace volcomp::xyfz
