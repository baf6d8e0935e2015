// The CAN database in firmware/ is the one the code makes for a bus with node 32, controller 127
// and drives 1, 2, 3 of X, Y, Z; buses that cannot be are refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "host_sim/host/bus/device_files/bus_messages.hpp"
#include "host_sim/host/bus/device_files/dbc.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "tests/host_sim/host/bus/device_files/device_files_support.hpp"

namespace volcomp::node::test {
namespace {

using canopen::AbortCode;
using ::testing::HasSubstr;

// Drives 1, 2, 3 …
host::BusSettings bus_with(const std::string& letters) {
  host::BusSettings bus;
  for (const char letter : letters) {
    host::BusAxis axis;
    axis.letter = letter;
    axis.drive = static_cast<std::uint8_t>(bus.axes.size() + 1);
    bus.axes.push_back(axis);
  }
  return bus;
}

TEST(CommittedDatabase, IsTheOneTheCodeMakes) {
  EXPECT_TRUE(project_file("firmware/volcomp.dbc") == host::make_dbc(bus_with("XYZ")))
      << kRegenerate;
}

// Identifier → bytes, of every message.
std::map<unsigned, std::size_t> messages_of(const std::string& dbc) {
  std::map<unsigned, std::size_t> messages;
  const std::regex line("BO_ ([0-9]+) [A-Za-z_]+: ([0-9]) [A-Za-z_]+\n");
  for (std::sregex_iterator m(dbc.begin(), dbc.end(), line), end; m != end; ++m)
    messages[static_cast<unsigned>(std::stoul((*m)[1]))] = std::stoul((*m)[2]);
  return messages;
}

// A node with its drives set: what it waits for and what it sends is in the database.
TEST(CommittedDatabase, HoldsEveryPdoOfTheNode) {
  const auto messages = messages_of(project_file("firmware/volcomp.dbc"));
  NodeOnTheBus node;
  for (std::uint8_t axis = 1; axis <= 3; ++axis)
    ASSERT_EQ(node.write({0x2010, axis}, {axis}), AbortCode::none);
  int valid = 0;
  for (const unsigned first : {0x1400U, 0x1800U}) {
    for (unsigned pdo = first; node.exists({static_cast<std::uint16_t>(pdo), 1}); ++pdo) {
      const auto mapping = static_cast<std::uint16_t>(pdo + 0x200);
      const std::uint32_t cob_id = node.number({static_cast<std::uint16_t>(pdo), 1});
      if ((cob_id & 0x8000'0000U) != 0) continue;
      ++valid;
      std::size_t bits = 0;
      for (std::uint32_t sub = 1; sub <= node.number({mapping, 0}); ++sub)
        bits += node.number({mapping, static_cast<std::uint8_t>(sub)}) & 0xFFU;
      const auto found = messages.find(cob_id & 0x7FFU);
      ASSERT_NE(found, messages.end()) << std::hex << cob_id;
      EXPECT_EQ(8 * found->second, bits) << std::hex << cob_id;
    }
  }
  // Command, actual, held offset, latch, edge counter and offset of three axes; what the
  // controller grinds, temperatures; node status, points.
  EXPECT_EQ(valid, 24);
}

// Each sent by one station, and no signal over another or over the end. TIME has four reserved bits
// (CiA 301, 7.1.6.5).
TEST(Database, SignalsFitTheirMessages) {
  for (const host::BusMessage& m : host::bus_messages(bus_with("XYZAB"))) {
    std::size_t end = 0;
    for (const host::BusSignal& s : m.signals) {
      EXPECT_EQ(s.first_bit, end + (m.name == "TIME" && end == 28 ? 4 : 0))
          << m.name << '.' << s.name;
      end = s.first_bit + s.bits;
    }
    EXPECT_EQ(end, 8 * m.size) << m.name;
  }
}

// 2^31 units are a turn.
TEST(Database, RotaryPositionsAreInDegrees) {
  host::BusSettings bus = bus_with("A");
  bus.axes[0].rotary = true;
  for (const host::BusMessage& m : host::bus_messages(bus)) {
    if (m.name != "A_Command") continue;
    EXPECT_EQ(m.signals.at(1).unit, "deg");
    EXPECT_DOUBLE_EQ(m.signals.at(1).factor * 0x4000'0000, 180.0);
    return;
  }
  FAIL() << "no A_Command";
}

// --- refused, each in one sentence

std::string refusal(const host::BusSettings& bus) {
  try {
    static_cast<void>(host::make_dbc(bus));
  } catch (const host::UserError& e) {
    return e.what();
  }
  return "";
}

TEST(Database, TwoStationsCannotShareANodeId) {
  host::BusSettings bus = bus_with("XY");
  bus.axes[1].drive = 1;
  EXPECT_THAT(refusal(bus), HasSubstr("two stations have node id 1"));
  bus.axes[1].drive = bus.controller;
  EXPECT_THAT(refusal(bus), HasSubstr("two stations have node id 127"));
}

TEST(Database, NodeIdsAreFrom1To127) {
  host::BusSettings bus = bus_with("X");
  bus.axes[0].drive = 0;
  EXPECT_THAT(refusal(bus), HasSubstr("node id 0"));
  bus = bus_with("X");
  bus.node = 128;
  EXPECT_THAT(refusal(bus), HasSubstr("node id 128"));
  bus = bus_with("X");
  bus.controller = 0;
  EXPECT_THAT(refusal(bus), HasSubstr("node id 0"));
}

TEST(Database, AxesAreLettersGivenOnce) {
  EXPECT_THAT(refusal(bus_with("X1")), HasSubstr("\"1\" is not an axis letter"));
  EXPECT_THAT(refusal(bus_with("XX")), HasSubstr("two axes are called X"));
}

TEST(Database, ANodeHasRoomForFiveAxes) {
  EXPECT_EQ(refusal(bus_with("XYZAB")), "");
  EXPECT_THAT(refusal(bus_with("XYZABC")), HasSubstr("5 axes, 6 are given"));
}

}  // namespace
}  // namespace volcomp::node::test
