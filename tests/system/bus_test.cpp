// The compensation node on the bus does what the integrated form does.

#include <algorithm>

#include <gtest/gtest.h>

#include "comp/metrology/tables/compensated_command.hpp"
#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/host/bus/bus_load.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

constexpr double kFeed_mm_s = 10'000.0 / 60.0;

std::vector<host::Offsets> offsets_along(MotionCell& cell, const Diagonal& line) {
  std::vector<host::Offsets> offsets;
  cell.place(line.start);
  cell.move_to(line.end, kFeed_mm_s,
               [&](const MotionCell& c) { offsets.push_back(c.axes().offset()); });
  return offsets;
}

TEST(Bus, OffsetsAreThoseOfTheIntegratedFormToTheBit) {
  const BusMachine& m = bus_machine();
  const auto integrated = make_integrated_cell(m.truth, m.file.correction, m.image);
  const auto bus = bus_cells(m.file, kBusCycle_hz)(m.truth, m.file.correction, m.image);
  const Diagonal line = body_diagonals(travel_box(m.file))[kPnp];
  const std::vector<host::Offsets> expected = offsets_along(*integrated, line);
  ASSERT_GT(expected.size(), 1000U);
  EXPECT_EQ(offsets_along(*bus, line), expected);
}

// Every frame as long as it can get with stuff bits: the cycle still fits the bus.
TEST(Bus, HasRoomForTheCycleOfThreeAxesWithTheLongestFrames) {
  BusAxes axes(bus_machine_settings(), bus_machine().image, hal::FrameLength::worst_case);
  axes.stand_at({-250.0, -150.0, -200.0});
  axes.bring_up();
  const std::uint64_t busy_ns = axes.bus().bus().busy_ns();
  const std::uint64_t begin_ns = axes.bus().bus().now_ns();
  const host::Targets target = axes.target();
  for (int i = 0; i < 1000; ++i)
    axes.cycle(target);
  const double load = static_cast<double>(axes.bus().bus().busy_ns() - busy_ns) /
                      static_cast<double>(axes.bus().bus().now_ns() - begin_ns);
  EXPECT_LT(load, 0.8);
  EXPECT_NEAR(load, host::compute_bus_load(3, kBusCycle_hz).worst, 0.005);
  EXPECT_EQ(axes.node()->objects().deadline_missed, 0U);
  EXPECT_EQ(axes.node()->objects().cycles_skipped, 0U);
}

TEST(Bus, LineAtTenMetresPerMinuteIsCompensatedWithinTwoNanometres) {
  const BusMachine& m = bus_machine();
  const xyfz::Dynamics d =
      xyfz::run_dynamics(m.truth, m.file, *m.built, bus_cells(m.file, kBusCycle_hz));
  EXPECT_LE(d.line_worst_nm, 2.0);
  EXPECT_GT(d.line_worst_nm, 0.0);
}

// No drift, no memory of the way: the same place from the same side has the same offsets.
TEST(Bus, ManyJourneysLaterTheOffsetsAreTheSame) {
  BusWorld world(5);
  ASSERT_TRUE(world.approach());
  const host::Offsets before = world.offsets();
  world.run(20'000);
  ASSERT_TRUE(world.approach());
  EXPECT_EQ(world.offsets(), before);
  EXPECT_TRUE(world.violation().empty()) << world.violation();
  EXPECT_TRUE(world.trouble().empty()) << world.trouble();
}

}  // namespace
}  // namespace volcomp::sim
