// The motion controller on the simulated bus: what it refuses to work with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/status.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "tests/complaint.hpp"

namespace volcomp::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kShortTime_s = 2.0;

host::BusSettings xyfz() {
  return host::bus_settings(host::read_machine_file(host::bundled_machine("xyfz")), 500.0);
}

std::string refusal(const host::BusSettings& settings, const std::vector<std::uint8_t>& image = {},
                    double seconds = kShortTime_s) {
  BusAxes axes(settings, image);
  return complaint_of([&] { return axes.bring_up(seconds), 0; });
}

TEST(BusController, BringsUpAMachineWithoutTables) { EXPECT_EQ(refusal(xyfz()), "accepted"); }

// The drives count nanometres (60A8h); a machine file with 2 nm per unit would correct twice as
// much as it should.
TEST(BusController, RefusesADriveWithOtherUnits) {
  host::BusSettings settings = xyfz();
  settings.axes[1].scale_numerator = 2;
  settings.axes[1].counts_otherwise = host::DriveScale{1, 1};
  const std::string text = refusal(settings);
  EXPECT_THAT(text, HasSubstr("axis Y"));
  EXPECT_THAT(text, HasSubstr("other units"));
}

// 2^31 units per turn on the wire are 512 run-time units (2^-40 turn) each.
TEST(BusController, ComparesTheFeedOfARotaryDrive) {
  host::BusSettings settings = xyfz();
  settings.axes[2].rotary = true;
  settings.axes[2].scale_numerator = 512;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.axes[2].scale_numerator = 1024;
  settings.axes[2].counts_otherwise = host::DriveScale{512, 1};
  EXPECT_THAT(refusal(settings), HasSubstr("units per turn"));
}

// Drives that count as in the file are taken as they are: micrometres, and no power of ten.
TEST(BusController, TakesDrivesThatCountAsTheFileSays) {
  for (const auto& [numerator, denominator] :
       {std::pair{1000U, 1U}, std::pair{78125U, 65536U}, std::pair{10U, 1U}}) {
    host::BusSettings settings = xyfz();
    settings.axes[0].scale_numerator = numerator;
    settings.axes[0].scale_denominator = denominator;
    EXPECT_EQ(refusal(settings), "accepted") << numerator;
    settings.axes[0].counts_otherwise = host::DriveScale{1, 1};
    EXPECT_THAT(refusal(settings), HasSubstr("other units")) << numerator;
  }
}

// However often it is tried again meanwhile, and in the words of the node.
TEST(BusController, SaysWhyTheNodeRefusedTheTables) {
  const std::vector<std::uint8_t> image(100, 0x55);
  const auto why = AllOf(HasSubstr("activation of the tables (2111h:00)"),
                         HasSubstr(sentence(Reason::bad_magic)));
  for (const double seconds : {1.9, 2.0, 2.05, 2.1, 2.15, 2.2})
    EXPECT_THAT(refusal(xyfz(), image, seconds), why) << seconds;
}

// A node that runs goes on with what it has; the machine stands until it has what it was given.
TEST(BusController, SaysWhyARunningNodeRefusedTheTables) {
  BusAxes axes(xyfz(), {});
  axes.bring_up(kShortTime_s);
  axes.controller().load_tables(std::vector<std::uint8_t>(100, 0x55));
  const std::vector<std::int32_t> stand{0, 0, 0};
  const auto cycles = static_cast<int>(kShortTime_s / axes.period_s());
  for (int i = 0; i < cycles; ++i)
    axes.run_cycle(stand);
  for (int i = 0; i < cycles; ++i) {
    axes.run_cycle(stand);
    ASSERT_THAT(axes.controller().trouble(), HasSubstr(sentence(Reason::bad_magic)));
  }
}

TEST(BusController, SaysWhoIsSilent) {
  BusAxes axes(xyfz(), {});
  axes.power_drive(2, false);
  try {
    axes.bring_up(kShortTime_s);
    FAIL() << "brought up without a drive";
  } catch (const host::UserError& e) {
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
  host::ProcessState state;
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
  EXPECT_THROW(axes.cycle({std::int64_t{1} << 31, 0, 0}), host::UserError);
}

}  // namespace
}  // namespace volcomp::sim
