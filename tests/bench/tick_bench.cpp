// One tick of the compensator: positions in, offsets out, with all limits and diagnostics.
//
//   cmake --preset host && cmake --build build/host --target volcomp_bench
//   build/host/tests/bench/volcomp_bench --benchmark_repetitions=5
//
// Compare Tick/xyfz_compiled_in with the Baseline/eighteen_lookups of the same run. Positions
// follow a random walk prepared beforehand, so that every tick looks somewhere else.

#include <cstdlib>

#include <benchmark/benchmark.h>

#include "comp/tick/instances.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp::bench {
namespace {

template <class Machine>
void run_ticks(benchmark::State& state, Compensator<Machine>& compensator,
               const MachineDescription& machine) {
  using Unit = Compensator<Machine>;
  constexpr std::size_t kAxes = Unit::kAxes;
  const Walk walk = make_walk(machine);
  std::vector<typename Unit::Input> inputs(walk.size());
  for (std::size_t i = 0; i < walk.size(); ++i) {
    for (std::size_t a = 0; a < kAxes; ++a)
      inputs[i].axis[a] = {walk[i][a], true, true};
  }
  typename Unit::Settings settings;
  for (AxisLimits& limits : settings.axis) {
    limits.rate = 1'000'000;
    limits.max_step = 1'000'000'000'000;
  }
  settings.ramp_ticks = 1;
  const auto tables = make_tables(machine);
  const Vec3 tool_point = Eigen::Map<const Vec3>(machine.tool_point.data());
  if (!compensator.configure(settings).ok() || !compensator.stage(*tables, tool_point, 0).ok() ||
      !compensator.activate().ok()) {
    std::abort();
  }

  typename Unit::Output out;
  std::size_t i = 0;
  for (auto _ : state) {
    compensator.tick(inputs[i++ % kWalk], out);
    benchmark::DoNotOptimize(out);
    benchmark::ClobberMemory();
  }
  for (std::size_t c = 0; c < machine.correcting_count; ++c) {
    if ((out.status[machine.correcting[c]] & kValid) == 0) state.SkipWithError("not compensating");
  }
}

template <class Machine>
void compiled_in(benchmark::State& state, const MachineDescription& machine) {
  const auto compensator = std::make_unique<Compensator<Machine>>();
  run_ticks(state, *compensator, machine);
}

void loaded(benchmark::State& state, const MachineDescription& machine, RuntimeModel model) {
  const auto compensator =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(machine, model)});
  run_ticks(state, *compensator, machine);
}

void xyfz_compiled_in(benchmark::State& state) {
  compiled_in<CompiledMachine<kXyfzMachine>>(state, kXyfzMachine);
}
void xyfz_loaded(benchmark::State& state) { loaded(state, kXyfzMachine, RuntimeModel::automatic); }
void generic_compiled_in(benchmark::State& state) {
  compiled_in<CompiledMachine<kGeneric, RuntimeModel::second_order>>(state, kGeneric);
}
void generic_loaded(benchmark::State& state) {
  loaded(state, kGeneric, RuntimeModel::second_order);
}
void grinder_compiled_in(benchmark::State& state) {
  compiled_in<CompiledMachine<kGrinder>>(state, kGrinder);
}
void grinder_loaded(benchmark::State& state) { loaded(state, kGrinder, RuntimeModel::automatic); }
void five_axis_compiled_in(benchmark::State& state) {
  compiled_in<CompiledMachine<kFiveAxis>>(state, kFiveAxis);
}
void five_axis_loaded(benchmark::State& state) {
  loaded(state, kFiveAxis, RuntimeModel::automatic);
}

BENCHMARK(xyfz_compiled_in)->Name("Tick/xyfz_compiled_in");
BENCHMARK(xyfz_loaded)->Name("Tick/xyfz_loaded");
BENCHMARK(generic_compiled_in)->Name("Tick/generic_second_order_compiled_in");
BENCHMARK(generic_loaded)->Name("Tick/generic_second_order_loaded");
BENCHMARK(grinder_compiled_in)->Name("Tick/xyb_against_a_compiled_in");
BENCHMARK(grinder_loaded)->Name("Tick/xyb_against_a_loaded");
BENCHMARK(five_axis_compiled_in)->Name("Tick/five_axis_compiled_in");
BENCHMARK(five_axis_loaded)->Name("Tick/five_axis_loaded");

}  // namespace
}  // namespace volcomp::bench
