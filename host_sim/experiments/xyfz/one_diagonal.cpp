#include "host_sim/experiments/xyfz/one_diagonal.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/bench.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

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
  const sim::MeasuredDiagonal& after = result.compensated;
  json rows = json::array();
  for (std::size_t i = 0; i < after.mean_um.size(); ++i)
    rows.push_back({after.distance_mm[i], result.uncompensated.mean_um[i], after.mean_um[i]});
  const json table = host::table_section(
      fmt::format("diagonal {}", after.name),
      {host::column("distance", "mm", 2), host::column("uncompensated", "µm", 3),
       host::column("compensated", "µm", 3)},
      rows);
  return host::text_of(
      {{"sections", json::array({table})},
       {"verdict",
        {{"ok", result.ok()},
         {"text", fmt::format("{:.2f} % of the largest deviation removed", result.rate())}}}});
}

}  // namespace volcomp::xyfz
