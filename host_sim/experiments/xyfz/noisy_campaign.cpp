#include "host_sim/experiments/xyfz/noisy_campaign.hpp"

#include <utility>

#include "host_sim/host/io/whole_file.hpp"

namespace volcomp::xyfz {
namespace {

std::uint64_t draw_seed(std::uint64_t seed, std::size_t draw) { return seed * 1'000'003U + draw; }

}  // namespace

sim::Campaign through_files(const sim::Campaign& campaign, const std::filesystem::path& folder) {
  host::create_folder(folder);
  sim::Campaign reread{campaign.machine, {}};
  for (const host::RunsFile& runs : campaign.runs) {
    const std::filesystem::path path = folder / runs.name;
    host::write_runs_file(path, runs);
    reread.runs.push_back(host::read_runs_file(path));
  }
  return reread;
}

sim::MeasuredDiagonal CheckedCampaign::pnp(const Bench& bench,
                                           const std::vector<std::uint8_t>& image) {
  return bench.pnp(at_check, image, sim::kDiagonalPoints, interferometer, random);
}

CheckedCampaign noisy_campaign(const Bench& bench, const std::filesystem::path& folder,
                               std::size_t draw) {
  const sim::NoiseClasses classes = bench.noise();
  const sim::Campaign measured = sim::measure_machine(bench.truth, bench.noisy_machine, classes,
                                                      bench.options.runs, bench.draw(draw));
  sim::Random random(draw_seed(bench.options.seed, draw));
  sim::TrueMachine at_check = bench.truth;
  at_check.temperature_offset_K = sim::check_temperature(classes, bench.draw(draw));
  const sim::InterferometerSetup setup{random.normal(classes.interferometer),
                                       classes.repeatability_mm,
                                       static_cast<int>(bench.options.runs)};
  return {through_files(measured, folder), at_check, setup, random};
}

CheckedCampaign noise_free_campaign(const Bench& bench, const std::filesystem::path& folder) {
  return {through_files(sim::perfect_campaign(bench.truth, bench.machine), folder),
          bench.truth,
          {},
          sim::Random(0)};
}

Compensated compensate(const Bench& bench, CheckedCampaign& measured) {
  Compensated out;
  out.pnp.raw_um = measured.pnp(bench, {}).max_abs_um;
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    auto tables = host::build_tables(measured.campaign.machine, measured.campaign.runs,
                                     host::tables_only(kModels[m], bench.options.knots));
    out.pnp.residual_um[m] = measured.pnp(bench, host::make_image(tables->tables)).max_abs_um;
    if (kModels[m] == host::ModelKind::abbe_closed) out.closed = std::move(tables);
  }
  return out;
}

}  // namespace volcomp::xyfz
