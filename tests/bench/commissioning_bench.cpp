// Commissioning work in double: building tables, folding them, the exact chain.

#include <cmath>

#include <benchmark/benchmark.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "comp/metrology/tables/table_builder.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "comp/tick/instances.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp::bench {
namespace {

// Runs of one axis, 11 targets, five in each direction.
struct Campaign {
  std::vector<double> positions;
  std::vector<std::vector<ErrorMotion>> values;
  std::vector<Run> up;
  std::vector<Run> down;
  MeasuredAxis measured;

  Campaign() {
    for (int i = 0; i < 11; ++i)
      positions.push_back(-500.0 + 50.0 * i);
    for (int run = 0; run < 10; ++run) {
      values.emplace_back();
      for (int t = 0; t < 11; ++t) {
        ErrorMotion e;
        for (Eigen::Index c = 0; c < 6; ++c)
          e(c) = (c < 3 ? 3e-3 : 2e-5) * std::sin(0.6 * t + static_cast<double>(c) + 0.01 * run);
        values.back().push_back(e);
      }
    }
    for (std::size_t r = 0; r < 5; ++r)
      up.emplace_back(values[r].data(), values[r].size());
    for (std::size_t r = 5; r < 10; ++r)
      down.emplace_back(values[r].data(), values[r].size());
    measured.letter = 'X';
    measured.positions = positions;
    measured.up = up;
    measured.down = down;
    measured.convention = Convention::relative;
    measured.sensed_at_zero = Vec3(250.0, 0.0, 550.0);
    measured.kappa = 1;
    measured.reference = 10;
  }
};

void build_refine_quantise(benchmark::State& state) {
  const auto campaign = std::make_unique<Campaign>();
  const auto built = std::make_unique<BuiltTable>();
  const auto fine = std::make_unique<ErrorTable>();
  AxisTable table;
  bool ok = true;
  for (auto _ : state) {
    ok = ok && build_table(campaign->measured, *built).ok() &&
         refine(built->table, Interpolation::catmull_rom, 8, *fine).ok() &&
         quantise(*fine, kGeneric.body[1].joint, 128, table).ok();
    benchmark::DoNotOptimize(table);
    benchmark::ClobberMemory();
  }
  if (!ok) state.SkipWithError("refused");
}

void fold(benchmark::State& state) {
  const auto tables = make_tables(kXyfzMachine);
  const RuntimeChain chain = make_runtime_chain(kXyfzMachine);
  const auto view = std::make_unique<TablesView>();
  const auto set = std::make_unique<TableSet<3, 128>>();
  FoldReport report;
  bool ok = view_tables(*tables, *view).ok();
  for (auto _ : state) {
    ok = ok && fold_tables(*view, chain, Vec3(30, -380, -300), TableSetView(*set), report).ok();
    benchmark::DoNotOptimize(*set);
    benchmark::ClobberMemory();
  }
  if (!ok) state.SkipWithError("refused");
}

void exact_chain(benchmark::State& state, const MachineDescription& machine) {
  MachineChain chain;
  if (!MachineChain::build(machine, chain).ok()) state.SkipWithError("refused");
  const Walk walk = make_walk(machine);
  ErrorSet errors = zero_errors();
  for (ErrorMotion& e : errors)
    e << 1e-3, -2e-3, 3e-3, 1e-5, 2e-5, -3e-5;
  std::size_t i = 0;
  for (auto _ : state) {
    Pose q{};
    for (std::size_t a = 0; a < chain.axis_count(); ++a) {
      const bool rotary = chain.axis(a).kind == JointKind::rotary;
      q[a] = static_cast<double>(walk[i % kWalk][a]) / (rotary ? kUnitsPerRad : kNmPerMm);
    }
    ++i;
    VolumetricError error = exact_error(chain, q, errors, Vec3::Zero(), RotationModel::rxryrz,
                                        ideal_points(chain, q, chain.tool_point()));
    benchmark::DoNotOptimize(error);
  }
}

void exact_xyfz(benchmark::State& state) { exact_chain(state, kXyfzMachine); }
void exact_five_axis(benchmark::State& state) { exact_chain(state, kFiveAxis); }

BENCHMARK(build_refine_quantise)->Name("Commissioning/build_refine_and_quantise_one_axis");
BENCHMARK(fold)->Name("Commissioning/fold_xyfz");
BENCHMARK(exact_xyfz)->Name("Commissioning/exact_error_xyfz");
BENCHMARK(exact_five_axis)->Name("Commissioning/exact_error_five_axis");

}  // namespace
}  // namespace volcomp::bench
