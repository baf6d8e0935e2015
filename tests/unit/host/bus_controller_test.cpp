// The motion controller on the simulated bus: what it refuses to work with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/controller/bus_axes.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kShortTime_s = 2.0;

BusSettings xyfz() { return bus_settings(read_machine_file(bundled_machine("xyfz")), 500.0); }

std::string refusal(const BusSettings& settings, const std::vector<std::uint8_t>& image = {}) {
  BusAxes axes(settings, image);
  try {
    axes.bring_up(kShortTime_s);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(BusController, BringsUpAMachineWithoutTables) { EXPECT_EQ(refusal(xyfz()), ""); }

// The drives count nanometres (60A8h); a machine file that says 2 nm per unit would correct twice
// as much as it should.
TEST(BusController, RefusesADriveWithOtherUnits) {
  BusSettings settings = xyfz();
  settings.axes[1].scale_numerator = 2;
  const std::string text = refusal(settings);
  EXPECT_THAT(text, HasSubstr("axis Y"));
  EXPECT_THAT(text, HasSubstr("other units"));
}

// 2^31 units per turn on the wire are 512 run-time units (2^-40 turn) each.
TEST(BusController, ComparesTheFeedOfARotaryDrive) {
  BusSettings settings = xyfz();
  settings.axes[2].rotary = true;
  settings.axes[2].scale_numerator = 512;
  EXPECT_EQ(refusal(settings), "");
  settings.axes[2].scale_numerator = 1024;
  EXPECT_THAT(refusal(settings), HasSubstr("units per turn"));
}

TEST(BusController, SaysWhyTheNodeRefusedTheTables) {
  EXPECT_THAT(refusal(xyfz(), std::vector<std::uint8_t>(100, 0x55)),
              HasSubstr("activation of the tables (2111h:00)"));
}

TEST(BusController, SaysWhoIsSilent) {
  BusAxes axes(xyfz(), {});
  axes.power_drive(2, false);
  try {
    axes.bring_up(kShortTime_s);
    FAIL() << "brought up without a drive";
  } catch (const UserError& e) {
    EXPECT_THAT(e.what(), HasSubstr("drive Z (node 3) is silent"));
  }
}

// 201Ah of the node: slot and flags (u16), feed in nm/s (i32), little-endian.
TEST(BusController, TellsWhatIsGround) {
  BusAxes axes(xyfz(), {});
  std::vector<hal::CanFrame> seen;
  axes.bus().bus().set_observer(
      [&seen](std::uint64_t, const hal::CanFrame& frame, const hal::LoopbackBus::Port&) {
        if (frame.id == 0x1FF) seen.push_back(frame);
      });
  ProcessState state;
  state.slot = 300;
  state.stroke = Direction::backward;
  state.in_face = true;
  state.feed_nm_per_s = 13'400'000;
  axes.controller().send_process_state(state);
  axes.run_cycle({0, 0, 0});
  ASSERT_EQ(seen.size(), 1U);
  ASSERT_EQ(seen[0].size, 8);
  const std::array<std::uint8_t, 8> expected{0x2C, 0x01, 0x09, 0x00, 0xC0, 0x77, 0xCC, 0x00};
  EXPECT_EQ(seen[0].data, expected);
}

TEST(BusController, RefusesTargetsBeyondTheWire) {
  BusAxes axes(xyfz(), {});
  axes.stand_at({0.0, 0.0, 0.0});
  axes.cycle({0, 0, 0});
  EXPECT_THROW(axes.cycle({std::int64_t{1} << 31, 0, 0}), UserError);
}

}  // namespace
}  // namespace volcomp::sim
