// Machines with rotary axes under control, integrated and on the bus.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::sim {
namespace {

constexpr double kLinearUnit_mm = 1e-6;
constexpr double kRotaryUnit_rad = 2.0 * kPi / kDriveUnitsPerTurn;

// An L300G without errors.
struct Grinder {
  host::MachineFile file = host::read_machine_file(host::bundled_machine("l300g"));
  TrueMachine truth = [this] {
    TrueMachine machine;
    machine.chain = file.chain;
    return machine;
  }();
};

void expect_at(const MotionCell& cell, const Pose& pose) {
  const Pose shown = cell.axes().position();
  for (std::size_t a = 0; a < 4; ++a)
    EXPECT_NEAR(shown[a], pose[a], a < 2 ? kLinearUnit_mm : kRotaryUnit_rad) << "axis " << a;
  // Half a unit of B is 0.25 nm at the ball.
  EXPECT_LT(cell.deviation_mm().norm(), 2e-6);
}

void travel_about(MotionCell& cell) {
  const Pose start{0.0, 230.0, -0.68, 0.0};
  cell.place(start);
  expect_at(cell, start);
  // A goes on through more turns than 32 bits of the wire can hold.
  for (const Pose& to : {Pose{20.0, 235.0, -0.6, 0.4}, Pose{20.0, 235.0, -0.7, 9.0},
                         Pose{-20.0, 300.0, -0.7, -9.0}, start}) {
    cell.move_to(to, 20.0);
    expect_at(cell, to);
  }
}

TEST(RotaryAxes, GoWhereTheyAreToldInTheServoInterrupt) {
  const Grinder grinder;
  travel_about(*make_integrated_cell(grinder.truth, grinder.file.correction, {}));
}

TEST(RotaryAxes, GoWhereTheyAreToldOnTheBus) {
  const Grinder grinder;
  const CellFactory cells = bus_cells(grinder.file, kBusCycleOfFive_hz);
  travel_about(*cells(grinder.truth, grinder.file.correction, {}));
}

// 1 mrad is 2^32 / 2000π units of an offset.
TEST(RotaryAxes, HaveLimitsOfTheirOwn) {
  const Grinder grinder;
  const auto settings =
      host::compensator_settings(grinder.file.correction, host::axis_kinds(grinder.file.chain));
  EXPECT_EQ(settings.axis[1].limit, 200'000);
  EXPECT_EQ(settings.axis[2].limit, 683'565);
  EXPECT_EQ(settings.axis[2].hysteresis, 6'836);
  EXPECT_EQ(settings.axis[1].max_step, 1'000'000);
  EXPECT_EQ(settings.axis[2].max_step, std::llround(2.0 * 3.0e-3 * kUnitsPerRad));
}

}  // namespace
}  // namespace volcomp::sim
