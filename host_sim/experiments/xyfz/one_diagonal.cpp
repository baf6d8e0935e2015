#include "host_sim/experiments/xyfz/one_diagonal.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/bench.hpp"

namespace volcomp::xyfz {
namespace {

constexpr double kLeastRate = 98.0;

nlohmann::json figures_of(const sim::MeasuredDiagonal& diagonal) {
  return {{"distance_mm", diagonal.distance_mm},
          {"mean_um", diagonal.mean_um},
          {"max_abs_um", diagonal.max_abs_um},
          {"range_um", diagonal.range_um},
          {"reversal_um", diagonal.reversal_um}};
}

}  // namespace

double OneDiagonal::rate() const {
  return improvement_percent(uncompensated.max_abs_um, compensated.max_abs_um);
}

bool OneDiagonal::ok() const { return rate() >= kLeastRate; }

OneDiagonal run_one_diagonal(const XyfzOptions& options, const host::Progress& progress) {
  const Bench bench(options, progress);
  const sim::Campaign campaign = sim::perfect_campaign(bench.truth, bench.machine);
  const auto tables =
      host::build_tables(campaign.machine, campaign.runs,
                         host::tables_only(host::ModelKind::abbe_closed, options.knots));
  sim::Random unused(0);
  const auto measure = [&](const std::vector<std::uint8_t>& image) {
    return bench.pnp(bench.truth, image, sim::kKnotPoints, {}, unused);
  };
  OneDiagonal result;
  progress(0.1, "diagonal PNP, uncompensated");
  result.uncompensated = measure({});
  progress(0.5, "diagonal PNP, compensated");
  result.compensated = measure(host::make_image(tables->tables));
  progress(1.0, "done");
  return result;
}

nlohmann::json one_diagonal_figures(const OneDiagonal& result) {
  return {{"diagonal", result.compensated.name},
          {"uncompensated", figures_of(result.uncompensated)},
          {"compensated", figures_of(result.compensated)},
          {"rate_percent", result.rate()}};
}

std::string one_diagonal_summary(const OneDiagonal& result) {
  std::string text = fmt::format("diagonal {}\n     mm  uncompensated um  compensated um\n",
                                 result.compensated.name);
  for (std::size_t i = 0; i < result.compensated.mean_um.size(); ++i) {
    text += fmt::format("{:7.2f}  {:16.3f}  {:14.3f}\n", result.compensated.distance_mm[i],
                        result.uncompensated.mean_um[i], result.compensated.mean_um[i]);
  }
  return text + fmt::format("{} {:.2f} % of the largest deviation removed\n",
                            result.ok() ? "PASS" : "FAIL", result.rate());
}

}  // namespace volcomp::xyfz
