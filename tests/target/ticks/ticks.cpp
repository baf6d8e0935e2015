// Measures whole ticks on the board: instructions of each, least and most by kind, and the stack.
// The most expensive ticks are looked for by worst.cpp.
//
//   toolchain/run-firmware m7 ticks
//
// One line per figure, a word and fields name=value:
//   tick variant=… knots=… phase=usual|faults kind=… count=… min=… max=…   instructions
//   stack variant=… knots=… bytes=…
// The call of the tick with its arguments is included; what reading the counter costs is not.
//
// phase=usual is the ordinary operation of a machine, exchanges of tables with their ramps
// included. Exit code 1 when the counter cannot be trusted or a compensator refuses its tables.

#include <memory>

#include "tests/target/text.hpp"
#include "tests/target/ticks/machines.hpp"
#include "tests/target/ticks/tick_run.hpp"

namespace volcomp::target {
namespace {

constexpr std::uint32_t kOrdinaryTicks = 20'000;
constexpr std::uint32_t kFaultTicks = 5'000;
constexpr std::size_t kFewKnots = 11;

InstructionCounter counter;

struct Variant {
  const char* name;
  const MachineDescription& machine;
  std::size_t knots;
};

void print(const Variant& variant, const char* phase, const Tally& tally) {
  for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
    const Tally::Entry& entry = tally.of(kind);
    if (entry.count == 0) continue;
    put("tick");
    put_field("variant", variant.name);
    put_field("knots", variant.knots);
    put_field("phase", phase);
    put_field("kind", kKindNames[kind]);
    put_field("count", entry.count);
    put_field("min", entry.least);
    put_field("max", entry.most);
    put('\n');
  }
}

// Other values everywhere, so that an exchange is a change.
void reverse(MachineTables& tables) {
  for (AxisTable& axis : tables.axis) {
    for (auto& column : axis.value) {
      for (Channels& knot : column) {
        for (float& value : knot)
          value *= -0.7F;
      }
    }
  }
}

template <class Unit>
void measure(const Variant& variant, std::unique_ptr<Unit> unit) {
  const auto one = bench::make_tables(variant.machine, variant.knots);
  const auto other = bench::make_tables(variant.machine, variant.knots);
  reverse(*other);
  TickRun<Unit> run(*unit, {one.get(), other.get()}, counter);
  Tally usual;
  Tally faults;
  run.operate(kOrdinaryTicks, usual);
  run.suffer(kFaultTicks, faults);
  print(variant, "usual", usual);
  print(variant, "faults", faults);
  put("stack");
  put_field("variant", variant.name);
  put_field("knots", variant.knots);
  put_field("bytes", run.stack_bytes());
  put('\n');
}

template <class Machine>
void measure_compiled(const Variant& variant) {
  measure(variant, std::make_unique<Compensator<Machine>>());
}

void measure_loaded(const Variant& variant) {
  const LoadedMachine<5> machine{make_runtime_chain(variant.machine)};
  measure(variant, std::make_unique<LoadedCompensator>(machine));
}

void measure_all() {
  using bench::kKnots;
  const Variant xyfz{"xyfz_compiled", kXyfzMachine, kKnots};
  measure_compiled<CompiledMachine<kXyfzMachine>>(xyfz);
  measure_compiled<CompiledMachine<kXyfzMachine>>({xyfz.name, xyfz.machine, kFewKnots});
  measure_loaded({"xyfz_loaded", kXyfzMachine, kKnots});
  measure_compiled<GenericMachine>({"xyz_second_order_compiled", bench::kGeneric, kKnots});
  measure_compiled<GrinderMachine>({"xyb_a_compiled", bench::kGrinder, kKnots});
  measure_loaded({"xyb_a_loaded", bench::kGrinder, kKnots});
  measure_compiled<FiveAxisMachine>({"five_axis_compiled", bench::kFiveAxis, kKnots});
  const Variant five_axis{"five_axis_loaded", bench::kFiveAxis, kKnots};
  measure_loaded(five_axis);
  measure_loaded({five_axis.name, five_axis.machine, kFewKnots});
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  counter.start();
  measure_all();
  if (!counter.exact())
    stop("The counter does not count instructions: start QEMU with -icount shift=6,sleep=off.");
  return 0;
}
