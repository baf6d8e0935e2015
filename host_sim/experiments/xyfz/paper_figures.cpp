#include "host_sim/experiments/xyfz/paper_figures.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/report/shared_progress.hpp"

namespace volcomp::xyfz {
namespace {

constexpr double kNoiseFreeDone = 0.1;

// Every draw at its place, of levers and prediction alike.
void make_room(std::size_t draws, PaperFigures& result) {
  for (const LeverExperiment& experiment : lever_experiments()) {
    LeverResult lever{experiment, {}};
    lever.readings.front().resize(1);
    for (std::size_t noise = 1; noise < kLeverNoises; ++noise)
      lever.readings.at(noise).resize(draws);
    result.levers.push_back(std::move(lever));
  }
  result.prediction.resize(draws);
}

void run_noise_free_figures(const Bench& bench, PaperFigures& result) {
  for (LeverResult& lever : result.levers)
    lever.readings.front().front() = measure_levers(bench, lever.experiment, LeverNoise::none, 0);
  const host::TemporaryFolder folder;
  CheckedCampaign measured = noise_free_campaign(bench, folder.path());
  result.noise_free = predict_pnp(bench, measured);
}

void run_draw_of_figures(const Bench& bench, std::size_t draw, PaperFigures& result) {
  for (LeverResult& lever : result.levers)
    for (const LeverNoise noise : {LeverNoise::instrument, LeverNoise::temperature})
      lever.readings.at(static_cast<std::size_t>(noise))[draw] =
          measure_levers(bench, lever.experiment, noise, draw);
  const host::TemporaryFolder folder;
  CheckedCampaign measured = noisy_campaign(bench, folder.path(), draw);
  result.prediction[draw] = predict_pnp(bench, measured);
}

}  // namespace

PaperFigures run_paper_figures(const XyfzOptions& options, const host::Progress& progress) {
  PaperFigures result;
  result.options = options;
  const Bench bench(options, progress);
  result.tuning = bench.tuning;
  result.noise = bench.noise();
  result.inputs = {host::hashed_file("machine file", options.machine)};
  make_room(options.draws, result);
  run_noise_free_figures(bench, result);
  host::SharedProgress shared(progress, options.draws, kNoiseFreeDone);
  host::in_parallel(options.draws, options.threads, [&](std::size_t draw) {
    run_draw_of_figures(bench, draw, result);
    shared.show(draw, 1.0, fmt::format("draw {} of {}", draw + 1, options.draws));
  });
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::xyfz
