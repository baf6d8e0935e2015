// A machine that gets warm while the node on its bus compensates it. The oracle is the simulated
// machine: where its grown scales take the tool, measured as by an interferometer.

#include <gtest/gtest.h>

#include "firmware/canopen/emergency.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

constexpr float kSteel_per_K = 11.7e-6F;  // as the scales of the simulated machine
constexpr std::int64_t k2030 = 1'893'456'000;
constexpr std::array<double, 3> kWarmer_K{3.0, -2.0, 1.5};

// Tables of the machine at 20 °C, with what its scales do, good until 2030.
std::vector<std::uint8_t> growing_image() {
  MachineTables tables = bus_machine().built->tables;
  tables.provenance.temperature_C = 20.0F;
  tables.provenance.expires_unix_s = k2030;
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    tables.expansion[a] = {kSteel_per_K, 0.0F, static_cast<std::uint8_t>(a)};
  return host::make_image(tables);
}

TrueMachine warm_truth() {
  TrueMachine truth = bus_machine().truth;
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    truth.warmer_K.at(a) = kWarmer_K[a];
  return truth;
}

// What is left of the error at a place that the axes were sent to, um.
Vec3 residual_um(const TrueMachine& truth, const Vec3& place, const BusAxes& axes) {
  const Pose q = axes.position();
  const Vec3 shown(q[0], q[1], q[2]);
  return 1e3 *
         (shown - place + truth.error(q, axes.approach(), truth.chain.tool_point()).position_work);
}

TEST(BusWarmMachine, StaysCompensatedWhileItGetsWarm) {
  const Vec3 before(-260.0, -160.0, -210.0);
  const Vec3 place(-250.0, -150.0, -200.0);
  const TrueMachine cold = bus_machine().truth;
  const TrueMachine warm = warm_truth();
  BusWorld world(11, growing_image());
  const auto settled = [&] { return world.go_to(before) && world.go_to(place); };
  ASSERT_TRUE(settled());
  const Vec3 when_cold = residual_um(cold, place, world.axes());
  // Tables are zero at the reference of each axis, so a shift of the whole machine stays.
  const auto moved_by_warmth = [&] {
    return (residual_um(warm, place, world.axes()) - when_cold).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(moved_by_warmth(), 8.0);

  // 12 s; hundredths of a degree go over the bus.
  constexpr int kSteps = 60;
  for (int i = 1; i <= kSteps; ++i) {
    Temperatures now = kUnknownTemperatures;
    for (std::size_t a = 0; a < kBusMachineAxes; ++a)
      now.at(a) = 20.0F + static_cast<float>(kWarmer_K[a] * i / kSteps);
    world.controller().send_temperatures(now);
    world.run(100);
  }
  world.run(2000);
  ASSERT_TRUE(settled());
  // The node follows from 50 nm anywhere on an axis on.
  EXPECT_LT(moved_by_warmth(), 0.055);
  EXPECT_GT(world.node().thermal.followed, 5U);
  EXPECT_EQ(world.node().thermal.state, static_cast<std::uint8_t>(node::ThermalState::following));
  EXPECT_TRUE(world.violation().empty()) << world.violation();
  EXPECT_TRUE(world.trouble().empty()) << world.trouble();
}

TEST(BusWarmMachine, TheDateOfTheControllerEndsTheTables) {
  BusWorld world(12, growing_image());
  world.mark();
  world.controller().send_time(k2030 - 10);
  world.run(500);
  EXPECT_EQ(world.node().thermal.expired, 0);
  world.controller().send_time(k2030);
  world.run(500);
  EXPECT_EQ(world.node().thermal.expired, 1);
  EXPECT_TRUE(world.emergency(bus_machine_settings().node,
                              static_cast<std::uint16_t>(canopen::ErrorCode::tables_expired)))
      << world.emergencies();
  EXPECT_TRUE(world.violation().empty()) << world.violation();
}

}  // namespace
}  // namespace volcomp::sim
