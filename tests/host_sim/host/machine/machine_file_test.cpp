// Machine files: the bundled XYFZ machine is the one of docs/papers/xyfz.md, other machines need
// only a file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/tick/instances.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "tests/host_sim/host/machine/changed_machine.hpp"
#include "tests/oracle/l300g_machine.hpp"

namespace volcomp::host {
namespace {

TEST(MachineFile, BundledXyfzIsTheCompiledInMachine) {
  const MachineFile file = read_machine_file(bundled_machine("xyfz"));
  EXPECT_TRUE(
      same_chain(make_runtime_chain(file.chain.description()), make_runtime_chain(kXyfzMachine)));
  EXPECT_EQ(file.chain.description().tool_point, kXyfzMachine.tool_point);
  EXPECT_EQ(file.convention, Convention::relative);
  EXPECT_EQ(file.side, Side::moving);
  // The paper's Table 6: 26.25, 45.83 and 3.58 arc seconds.
  EXPECT_NEAR(file.squareness->measured.a_xy, 127.264e-6, 1e-12);
  EXPECT_NEAR(file.squareness->measured.a_xz, 222.190e-6, 1e-12);
  EXPECT_NEAR(file.squareness->measured.a_yz, 17.356e-6, 1e-12);
}

TEST(MachineFile, BundledL300gIsTheMachineOfThePaper) {
  const MachineFile file = read_machine_file(bundled_machine("l300g"));
  MachineChain chain;
  ASSERT_TRUE(MachineChain::build(
                  test::l300g_machine({173.7135, -39.025 * kPi / 180.0}, {0.0, 168.8053}), chain)
                  .ok());
  EXPECT_TRUE(same_chain(make_runtime_chain(file.chain.description()),
                         make_runtime_chain(chain.description())));
  const Pose q{12.0, 230.0, -0.6, 2.5};
  for (const auto branch : {&MachineChain::tool, &MachineChain::work}) {
    const Frame from_file = file.chain.ideal((file.chain.*branch)(), q);
    const Frame expected = chain.ideal((chain.*branch)(), q);
    EXPECT_EQ(from_file.t, expected.t);
    EXPECT_EQ(from_file.R, expected.R);
  }
  EXPECT_EQ(file.chain.tool_point(), chain.tool_point());
  EXPECT_EQ(file.chain.description().correcting, chain.description().correcting);
  // The probe of the paper, 16.4935 mm less the mandrel's 15 mm.
  ASSERT_TRUE(file.probe.has_value());
  EXPECT_NEAR(file.probe->radius_mm, 16.4935 - 15.0, 1e-12);
}

// A machine no paper has: a rotary table C on X, nothing but a file.
constexpr const char* kRotary = R"(
name = "table"
id = 7
convention = "body"
side = "fixed"
tool = { body = "Z", point_mm = [0.0, 0.0, -120.0] }
work = { body = "C" }
body = [
  { name = "bed" },
  { name = "X", on = "bed", joint = "linear", axis = "X", moves_along = "X", sign = -1 },
  { name = "C", on = "X", joint = "rotary", axis = "C", turns_about = "Z", sign = 1, offset_mm = [10.0, 0.0, 50.0] },
  { name = "Z", on = "bed", joint = "linear", axis = "Z", moves_along = "Z", sign = 1 },
]
axis = [
  { name = "X", travel_mm = [0.0, 500.0], reference_mm = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
  { name = "Z", travel_mm = [0.0, 300.0], reference_mm = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
  { name = "C", travel_rad = [0.0, 6.283185307179586], reference_rad = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
]
correction = { axes = ["X", "Z"] }
)";

TEST(MachineFile, DescribesARotaryMachine) {
  const MachineFile file = parse_machine(kRotary, "m.toml");
  EXPECT_TRUE(file.chain.has_rotary());
  EXPECT_EQ(file.chain.axis_count(), 3U);
  EXPECT_EQ(file.chain.axis(2).letter, 'C');
  EXPECT_EQ(file.chain.axis(2).branch, Branch::work);
  EXPECT_EQ(file.chain.axis(1).branch, Branch::tool);
  EXPECT_EQ(file.side, Side::fixed);
  EXPECT_EQ(file.chain.description().correcting_count, 2);
  EXPECT_FALSE(file.squareness.has_value());
}

TEST(MachineFile, ATurnAsPeopleWriteItIsATurn) {
  for (const char* turn : {"6.283185307179586", "6.2832", "6.28318"}) {
    const MachineFile file = parse_machine(changed(kRotary, "6.283185307179586", turn), "m.toml");
    EXPECT_TRUE(file.axes[2].full_turn()) << turn;
  }
  EXPECT_FALSE(
      parse_machine(changed(kRotary, "6.283185307179586", "6.25"), "m.toml").axes[2].full_turn());
}

constexpr const char* kThermal = R"([thermal]
reference_C = 21.5
expires_days = 90
[thermal.Z]
per_K = 11.7e-6
fixed_mm = 300
input = 2
)";

TEST(MachineFile, AxesThatGrow) {
  const MachineFile plain = parse_machine(kRotary, "m.toml");
  EXPECT_EQ(plain.thermal.reference_C, 20.0);
  EXPECT_EQ(plain.thermal.expires_days, 0.0);
  EXPECT_EQ(plain.thermal.expansion[1].input, kNoTemperature);
  const MachineFile file = parse_machine(std::string(kRotary) + kThermal, "m.toml");
  EXPECT_EQ(file.thermal.reference_C, 21.5);
  EXPECT_EQ(file.thermal.expires_days, 90.0);
  EXPECT_EQ(file.thermal.expansion[0].input, kNoTemperature);
  EXPECT_EQ(file.thermal.expansion[1].per_K, 11.7e-6F);
  EXPECT_EQ(file.thermal.expansion[1].fixed_mm, 300.0F);
  EXPECT_EQ(file.thermal.expansion[1].input, 2);
}

TEST(MachineFile, RefusalsOfGrowthNameLineAndField) {
  using testing::HasSubstr;
  const std::string text = std::string(kRotary) + kThermal;
  EXPECT_THAT(refusal_of(text, "reference_C = 21.5", "reference_C = 81"),
              HasSubstr("'reference_C' must be from -20 to 80"));
  EXPECT_THAT(refusal_of(text, "expires_days = 90", "expires_days = -1"),
              HasSubstr("'expires_days' must be from 0"));
  EXPECT_THAT(refusal_of(text, "11.7e-6", "11.7"), HasSubstr("'per_K' must be from"));
  EXPECT_THAT(refusal_of(text, "fixed_mm = 300", "fixed_mm = 5001"),
              HasSubstr("'fixed_mm' must be from -5000 to 5000"));
  EXPECT_THAT(refusal_of(text, "input = 2", "input = 4"), HasSubstr("input"));
  EXPECT_THAT(refusal_of(text, "input = 2", ""), HasSubstr("input"));
  EXPECT_THAT(refusal_of(text, "fixed_mm = 300", ""), HasSubstr("fixed_mm"));
  EXPECT_THAT(refusal_of(text, "[thermal.Z]", "[thermal.C]"), HasSubstr("bad_thermal"));
  EXPECT_THAT(refusal_of(text, "[thermal.Z]", "[thermal.Y]"), HasSubstr("'Y'"));
}

TEST(MachineFile, RefusalsNameLineAndField) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal_of(kRotary, "sign = -1", "sign = 0"),
              HasSubstr("m.toml:10: 'sign' must be 1 or -1"));
  EXPECT_THAT(refusal_of(kRotary, "turns_about", "moves_along"), HasSubstr("turns_about"));
  EXPECT_THAT(refusal_of(kRotary, "axis = \"C\"", "axis = \"Q\""),
              HasSubstr("must be one of X Y Z A B C"));
  EXPECT_THAT(refusal_of(kRotary, "axis = \"C\"", "axis = \"B\""),
              HasSubstr("axis B has no [[axis]] table"));
  EXPECT_THAT(refusal_of(kRotary, "[0.0, 500.0]", "[500.0, 0.0]"),
              HasSubstr("must be [low, high]"));
  EXPECT_THAT(refusal_of(kRotary, "reference_mm = 0.0", "reference_mm = -1.0"),
              HasSubstr("reference_out_of_range"));
  EXPECT_THAT(refusal_of(kRotary, "[0.0, 0.0, -120.0]", "[0.0, 0.0]"),
              HasSubstr("list of 3 numbers"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]", "axes = [\"X\", \"Y\"]"),
              HasSubstr("there is no axis Y"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]", "axes = []"),
              HasSubstr("one to 3 correcting axes"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]", "axes = [\"X\"], orienting = [\"X\"]"),
              HasSubstr("X does not turn: it cannot orient the tool"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]", "axes = [\"C\"], orienting = [\"C\"]"),
              HasSubstr("C takes another offset already"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]",
                         "axes = [\"X\"], orienting = [\"C\", \"C\", \"C\"]"),
              HasSubstr("one to 2 orienting axes"));
  EXPECT_THAT(refusal_of(kRotary, "id = 7", "id = -7"), HasSubstr("'id' must be a whole number"));
  EXPECT_THAT(refusal_of(kRotary, "id = 7", "id = 0"), HasSubstr("'id' must be a whole number"));
  EXPECT_THAT(refusal_of(kRotary, "6.283185307179586", "6.2834"), HasSubstr("[travel_too_long]"));
  EXPECT_THAT(refusal_of(kRotary, "kappa = 0 }", "kappa = 2 }"), HasSubstr("from -1 to 1"));
  EXPECT_THAT(refusal_of(kRotary, "on = \"X\"", "on = \"Z\""), HasSubstr("no earlier [[body]]"));
  EXPECT_THAT(refusal_of(kRotary, "name = \"bed\"", "name = \"bed\", on = \"bed\""),
              HasSubstr("m.toml:9: the first [[body]] is the bed"));
  EXPECT_THAT(refusal_of(kRotary, "sign = 1 }", "sign = 1, constant_error = [0, 0, 0, 0, 0, 0] }"),
              HasSubstr("'constant_error' is of bodies that do not move"));
  EXPECT_THAT(refusal_of(kRotary, "name = \"bed\"",
                         "name = \"bed\", constant_error = [1.1, 0, 0, 0, 0, 0]"),
              HasSubstr("'constant_error' is in mm and rad, up to 1 and 0.005"));
  EXPECT_THAT(refusal_of(kRotary, "travel_rad = [0.0, 6.283185307179586], reference_rad",
                         "travel_mm = [0.0, 6.3], reference_mm"),
              HasSubstr("axis C is rotary here, but its [[axis]] table says 'travel_mm'"));
  EXPECT_THAT(refusal_of(kRotary, "moves_along = \"X\"", "moves_along = \"X\", zero_deg = 1.0"),
              HasSubstr("m.toml:10: 'zero_deg' is for rotary joints"));
  EXPECT_THAT(refusal_of(kRotary, "axes = [\"X\", \"Z\"]", "axes = [\"X\"], limit_rad = 0.01"),
              HasSubstr("'limit_rad' must be from"));
  EXPECT_THAT(refusal_of(kRotary, "id = 7", "id = 7\nprobe = { radius_mm = 0.0 }"),
              HasSubstr("'radius_mm' must be above 0"));
  EXPECT_THAT(refusal_of(kRotary, "kappa = 0 }", "kappa = 0, latch_delay_us = -1.0 }"),
              HasSubstr("'latch_delay_us' must be from 0 to 50000"));
}

TEST(MachineFile, SaysHowASimulatedLaserErrs) {
  using testing::HasSubstr;
  const auto laser = [](const std::string& table) {
    return changed(kRotary, "id = 7", "id = 7\nlaser = { " + table + " }");
  };
  const LaserFile said =
      parse_machine(laser("drift = \"walk\", drift_um = 0.02, dwell_s = 10.0, growth_K = 0.5, "
                          "roll = \"level\""),
                    "m.toml")
          .laser;
  EXPECT_STREQ(kDriftNames.at(said.drift), "walk");
  EXPECT_NEAR(said.drift_mm, 0.02e-3, 1e-12);
  EXPECT_EQ(said.dwell_s, 10.0);
  EXPECT_EQ(said.growth_K, 0.5);
  EXPECT_TRUE(said.roll_by_level);
  EXPECT_THAT(machine_refusal(laser("drift = \"rain\"")), HasSubstr("m.toml:4: 'drift'"));
  EXPECT_THAT(machine_refusal(laser("drift_um = -1.0")), HasSubstr("'drift_um' must be from 0"));
  EXPECT_THAT(machine_refusal(laser("drift_tau_s = 0.0")), HasSubstr("'drift_tau_s' must be from"));
  EXPECT_THAT(machine_refusal(laser("growth_K = nan")), HasSubstr("growth_K"));
  EXPECT_THAT(machine_refusal(laser("colour = 1")), HasSubstr("colour"));
}

// The TOML library reads beyond the end of the last of them.
TEST(MachineFile, WhatIsNotUtf8IsRefusedAtItsLine) {
  using testing::HasSubstr;
  for (const char* bytes :
       {"\xE9", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2#", "\x80"})
    EXPECT_THAT(refusal_of(kRotary, "id = 7", std::string("id = 7 # ") + bytes),
                HasSubstr(": not UTF-8"));
  EXPECT_THAT(refusal_of(kRotary, "id = 7", "id = 7\n'\xF8ork '.irk #\xE2#"),
              HasSubstr("m.toml:4: not UTF-8"));
  EXPECT_EQ(refusal_of(kRotary, "id = 7", "id = 7 # \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"),
            "accepted");
}

TEST(MachineFile, DeepBracketsAreRefusedBeforeTheyAreParsed) {
  EXPECT_THROW(static_cast<void>(parse_machine("a = " + std::string(100000, '['), "x.toml")),
               UserError);
  EXPECT_THROW(static_cast<void>(parse_machine(std::string(2'000'000, 'a'), "x.toml")), UserError);
}

}  // namespace
}  // namespace volcomp::host
