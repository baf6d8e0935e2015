// Ticks to be traced instruction by instruction (toolchain/evidence/traced_tick.py): the last one
// is a plain tick of a machine that has been moving for a while. Prints nothing.

#include <memory>

#include "comp/core/units.hpp"
#include "tests/target/ticks/cost.hpp"
#include "tests/target/ticks/machines.hpp"

namespace volcomp::target {
namespace {

// From one knot interval to the next, forward: everything known, nothing limited, nothing ramped.
template <class Unit>
void move_plainly(const MachineDescription& machine, std::unique_ptr<Unit> unit) {
  constexpr std::int64_t kTicks = 5;
  const auto tables = bench::make_tables(machine);
  typename Unit::Settings settings;
  settings.ramp_ticks = 1;
  require(unit->configure(settings));
  const auto& tool = machine.tool_point;
  require(unit->stage(*tables, Vec3(tool[0], tool[1], tool[2]), 0));
  require(unit->activate());
  typename Unit::Input in{};
  typename Unit::Output out{};
  for (std::int64_t n = 0; n < kTicks; ++n) {
    for (std::size_t b = 0; b < machine.body_count; ++b) {
      const Joint& joint = machine.body[b].joint;
      if (!joint.moves()) continue;
      const bool rotary = joint.kind == JointKind::rotary;
      const std::int64_t way_unit = rotary ? kUnitsPerTurn / 6'283 : 1'000'000;
      const std::int64_t from = rotary ? kUnitsPerTurn / 50 : -400 * way_unit;
      in.axis[joint.nc_axis] = {from + 5 * n * way_unit, true, true};
    }
    unit->tick(in, out);
  }
  for (std::size_t a = 0; a < unit->machine().chain.axes; ++a) {
    if (out.status[a] != kValid) stop("The tick to be traced is not a plain one.");
  }
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  using namespace volcomp;          // NOLINT(google-build-using-namespace)
  move_plainly(kXyfzMachine, std::make_unique<XyfzCompensator>());
  const PositionMachine five_axis{make_runtime_chain(bench::kFiveAxis)};
  move_plainly(bench::kFiveAxis, std::make_unique<LoadedCompensator>(five_axis));
  return 0;
}
