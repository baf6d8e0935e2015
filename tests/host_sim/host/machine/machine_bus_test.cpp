// The bus in a machine file: node ids, units of the drives, software limits.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/machine/changed_machine.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

// The bundled machine with something after the name of an axis, and something at its end.
std::string trunnion_with(const std::string& axis, const std::string& fields,
                          const std::string& remove = "") {
  std::string text = text_of_file(bundled_machine("trunnion"));
  const std::size_t section = text.find("name = \"" + axis + "\"");
  EXPECT_NE(section, std::string::npos) << axis;
  if (!remove.empty()) {
    const std::size_t line = text.find(remove, section);
    EXPECT_NE(line, std::string::npos) << remove;
    text.erase(line, text.find('\n', line) - line);
  }
  return text.insert(text.find('\n', section), "\n" + fields);
}

BusAxis axis_of(const std::string& text, std::size_t a) {
  return bus_settings(parse_machine(text, "m.toml"), sim::kBusCycleOfFive_hz).axes.at(a);
}

TEST(MachineBus, ADriveThatCannotReportIsSaid) {
  EXPECT_TRUE(axis_of(trunnion_with("X", ""), 0).reports_offset);
  EXPECT_FALSE(axis_of(trunnion_with("X", "reports_offset = false"), 0).reports_offset);
  EXPECT_THAT(machine_refusal(trunnion_with("X", "reports_offset = 0")),
              HasSubstr("'reports_offset' must be true or false"));
}

// No data sheet lets 60B0h into a TPDO; what the file says itself wins.
TEST(MachineBus, ADriveIsNamedAndItsDataSheetSaysWhatItReports) {
  const BusAxis named = axis_of(trunnion_with("X", "drive = \"epos4_0170\""), 0);
  ASSERT_NE(named.model, nullptr);
  EXPECT_EQ(named.model->name(), "epos4_0170");
  EXPECT_EQ(named.way, Way::offset);
  EXPECT_FALSE(named.reports_offset);
  const std::string stated = "drive = \"epos4_0170\"\nreports_offset = true";
  EXPECT_TRUE(axis_of(trunnion_with("X", stated), 0).reports_offset);
  EXPECT_EQ(axis_of(trunnion_with("X", ""), 0).model, nullptr);
}

// EPOS4 and Elmo have no 1019h, the CL4-E has: SYNC with a counter needs all of them.
TEST(MachineBus, SyncHasNoCounterWhereADriveCannotCount) {
  const auto overflow = [](const std::string& fields) {
    return int{sync_counter_overflow(bus_settings(
        parse_machine(trunnion_with("X", fields), "m.toml"), sim::kBusCycleOfFive_hz))};
  };
  EXPECT_EQ(overflow(""), 240);
  EXPECT_EQ(overflow("drive = \"nanotec_cl4e\""), 240);
  EXPECT_EQ(overflow("drive = \"epos4_0170\""), 0);
}

TEST(MachineBus, WhatADriveCannotDoIsRefused) {
  const auto refusal = [](const std::string& fields) {
    return sim::complaint_of([&] { return axis_of(trunnion_with("X", fields), 0).drive; });
  };
  EXPECT_THAT(refusal("drive = \"epos4_0710\""), HasSubstr("m.toml: epos4_0710: no such drive"));
  EXPECT_THAT(refusal("drive = \"eyou\""), HasSubstr("axis X: the drive eyou"));
  EXPECT_THAT(refusal("drive = \"eyou\""), HasSubstr("60B0h is missing"));
  EXPECT_EQ(axis_of(trunnion_with("X", "drive = \"eyou\"\nway = \"forwarded\""), 0).way,
            Way::forwarded_target);
  EXPECT_THAT(machine_refusal(trunnion_with("X", "way = \"forward\"")),
              HasSubstr("must be one of: offset, forwarded, controller, none"));
}

TEST(MachineBus, UnitsAreExactRationals) {
  // 1 um: 1000 nm a unit.
  const BusAxis micrometre = axis_of(trunnion_with("X", "units_per_mm = 1000", "units_per_mm"), 0);
  EXPECT_EQ(micrometre.scale_numerator, 1000U);
  EXPECT_EQ(micrometre.scale_denominator, 1U);
  // An encoder of 2^23 counts on a screw of 10 mm: 10^7 nm / 2^23 = 78125/65536.
  const BusAxis screw =
      axis_of(trunnion_with("X", "units_per_mm = [8388608, 10]", "units_per_mm"), 0);
  EXPECT_EQ(screw.scale_numerator, 78125U);
  EXPECT_EQ(screw.scale_denominator, 65536U);
  // 2^23 counts behind a worm of 180: 2^40 / (180 * 2^23) = 32768/45.
  const BusAxis worm =
      axis_of(trunnion_with("A", "units_per_turn = 1509949440", "units_per_turn"), 3);
  EXPECT_EQ(worm.scale_numerator, 32768U);
  EXPECT_EQ(worm.scale_denominator, 45U);
}

// 0.001° is 2^40 / 360 000 = 2^34 / 5625 units of the run time: no fraction of 2^20.
TEST(MachineBus, ATurnOfDecimalDegreesIsCountedInUnitsPerTurn) {
  const BusAxis degrees =
      axis_of(trunnion_with("A", "units_per_turn = 360000", "units_per_turn"), 3);
  EXPECT_EQ(degrees.units_per_turn, 360'000U);
  EXPECT_NEAR(unit_size(degrees), 17179869184.0 / 5625.0, 1e-6);
  EXPECT_EQ(axis_of(trunnion_with("A", ""), 3).units_per_turn, 0U);
  EXPECT_THAT(machine_refusal(trunnion_with("A", "units_per_turn = 4294967297", "units_per_turn")),
              HasSubstr("neither may be above"));
}

// Half of 2^32 - 1 units are half a turn; C goes through a whole one.
TEST(MachineBus, ATravelThatLosesItsTurnsIsRefused) {
  EXPECT_THAT(machine_refusal(trunnion_with("C", "units_per_turn = 4294967295")),
              HasSubstr("units per turn only to 3.14159 rad, and beyond them the turn is lost"));
}

// Node and drives count 0.001°: A goes to the nearest unit, 17.5 µrad, and the others as ever.
TEST(MachineBus, AMachineOfDecimalDegreesGoesWhereItIsTold) {
  const MachineFile file =
      parse_machine(trunnion_with("A", "units_per_turn = 360000", "units_per_turn"), "m.toml");
  sim::TrueMachine truth;
  truth.chain = file.chain;
  const auto cell = sim::bus_cells(file, sim::kBusCycleOfFive_hz)(truth, file.correction, {});
  const Pose start{10.0, -20.0, -100.0, 0.1, 1.0};
  cell->place(start);
  const Pose to{12.0, -21.0, -101.0, 0.15, 1.1};
  cell->move_to(to, 50.0);
  constexpr double kUnit = 2.0 * kPi / 360'000.0;
  EXPECT_NEAR(cell->axes().position()[3], kUnit * std::round(0.15 / kUnit), 1e-9);
  EXPECT_NEAR(cell->axes().position()[0], 12.0, 1e-6);
  EXPECT_NEAR(cell->axes().position()[4], 1.1, 1e-8);
}

TEST(MachineBus, BitsThatMeanReferencedAreAMaskOrNone) {
  const auto mask_of = [](const std::string& field) {
    return parse_machine(trunnion_with("X", field), "m.toml").axes[0].drive.referenced_mask;
  };
  EXPECT_EQ(mask_of(""), std::nullopt);
  EXPECT_EQ(mask_of("referenced_mask = 4096"), 4096);
  EXPECT_EQ(mask_of("referenced_mask = \"none\""), 0);
  for (const char* const field :
       {"referenced_mask = 0", "referenced_mask = 65536", "referenced_mask = \"bit 8\""})
    EXPECT_THAT(machine_refusal(trunnion_with("X", field)), HasSubstr("referenced_mask"));
}

TEST(MachineBus, NodesAreWhereTheFileSays) {
  std::string text = trunnion_with("X", "node_id = 11", "node_id");
  text.replace(text.find("node_id = 32"), 12, "node_id = 40\ncontroller_id = 100");
  const BusSettings bus = bus_settings(parse_machine(text, "m.toml"), sim::kBusCycleOfFive_hz);
  EXPECT_EQ(bus.node, 40);
  EXPECT_EQ(bus.controller, 100);
  EXPECT_EQ(bus.axes[0].drive, 11);
  EXPECT_EQ(bus.axes[4].drive, 5);
}

TEST(MachineBus, WithoutAWordTheDrivesAreNumberedAndCountNanometres) {
  const BusSettings bus =
      bus_settings(read_machine_file(bundled_machine("l300g")), sim::kBusCycleOfFive_hz);
  EXPECT_EQ(bus.node, 32);
  EXPECT_EQ(bus.controller, 127);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_EQ(bus.axes[a].drive, a + 1);
    EXPECT_EQ(bus.axes[a].scale_numerator, a < 2 ? 1U : 512U);
    EXPECT_EQ(bus.axes[a].scale_denominator, 1U);
    EXPECT_EQ(bus.axes[a].lowest, bus.axes[a].highest);
  }
}

TEST(MachineBus, SoftwareLimitsAreInUnitsOfTheDrive) {
  const BusAxis x =
      axis_of(trunnion_with("X", "units_per_mm = 1000\nsoftware_limits_mm = [-255.5, 260.0]",
                            "units_per_mm"),
              0);
  EXPECT_EQ(x.lowest, -255'500);
  EXPECT_EQ(x.highest, 260'000);
}

TEST(MachineBus, RefusalsNameWhatIsWrong) {
  EXPECT_THAT(machine_refusal(trunnion_with("X", "node_id = 2", "node_id")),
              HasSubstr("axis X and axis Y both have the node id 2"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "node_id = 32", "node_id")),
              HasSubstr("the compensation node and axis X both have the node id 32"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "node_id = 128", "node_id")),
              HasSubstr("'node_id'"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "units_per_mm = 0", "units_per_mm")),
              HasSubstr("'units_per_mm' must be a whole number above 0"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "units_per_mm = [1, 2, 3]", "units_per_mm")),
              HasSubstr("'units_per_mm' must be a number or a list of 2"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "units_per_mm = 7654321", "units_per_mm")),
              HasSubstr("neither may be above 1048576"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "units_per_mm = 10000000", "units_per_mm")),
              HasSubstr("of axis X do not fit into its 32 bits"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "units_per_turn = 1000")),
              HasSubstr("is for rotary axes"));
  EXPECT_THAT(machine_refusal(trunnion_with("A", "units_per_mm = 1000")),
              HasSubstr("is for linear axes"));
  EXPECT_THAT(machine_refusal(trunnion_with("X", "software_limits_mm = [-100.0, 100.0]")),
              HasSubstr("around the travel"));
  EXPECT_THAT(
      machine_refusal(trunnion_with("X", "error_at_reference = [5.0, 0.0, 0.0, 0.0, 0.0, 0.0]")),
      HasSubstr("'error_at_reference' is in mm and rad"));
}

// Drives that count otherwise, elsewhere on the bus: the machine goes to the same places, to half a
// unit of its drives.
TEST(MachineBus, AMachineOfCoarseDrivesGoesWhereItIsTold) {
  std::string text = trunnion_with("X", "node_id = 21\nunits_per_mm = 100000", "node_id");
  text.erase(text.find("units_per_mm = 1000000"), 22);
  text.replace(text.find("node_id = 32"), 12, "node_id = 50");
  const MachineFile file = parse_machine(text, "m.toml");
  sim::TrueMachine truth;
  truth.chain = file.chain;
  const auto cell = sim::bus_cells(file, sim::kBusCycleOfFive_hz)(truth, file.correction, {});
  const Pose start{10.000004, -20.0, -100.0, 0.1, 1.0};
  cell->place(start);
  const Pose to{12.000004, -21.0, -101.0, 0.15, 1.1};
  cell->move_to(to, 50.0);
  EXPECT_NEAR(cell->axes().position()[0], 12.0, 1e-6);  // not 12.000004: units of 10 nm
  EXPECT_NEAR(cell->axes().position()[1], -21.0, 1e-6);
  EXPECT_NEAR(cell->axes().position()[3], 0.15, 1e-8);
}

}  // namespace
}  // namespace volcomp::host
