// The finite state automaton of CiA 402-2: every transition, every statusword pattern, and that
// nothing else is possible.

#include <gtest/gtest.h>

#include <map>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

// Controlwords of the standard's command table, "don't care" bits 0.
constexpr std::uint16_t kShutdown = 0x06;
constexpr std::uint16_t kSwitchOn = 0x07;
constexpr std::uint16_t kEnable = 0x0F;
constexpr std::uint16_t kDisableVoltage = 0x00;
constexpr std::uint16_t kQuickStop = 0x02;
constexpr std::uint16_t kDisableOperation = 0x07;

// Statusword patterns: mask and value.
struct Pattern {
  std::uint16_t mask = 0;
  std::uint16_t value = 0;
};
const std::map<host::PowerState, Pattern> kPatterns{
    {host::PowerState::not_ready_to_switch_on, {0x004F, 0x0000}},  // x0xx 0000
    {host::PowerState::switch_on_disabled, {0x004F, 0x0040}},      // x1xx 0000
    {host::PowerState::ready_to_switch_on, {0x006F, 0x0021}},      // x01x 0001
    {host::PowerState::switched_on, {0x006F, 0x0023}},             // x01x 0011
    {host::PowerState::operation_enabled, {0x006F, 0x0027}},       // x01x 0111
    {host::PowerState::quick_stop_active, {0x006F, 0x0007}},       // x00x 0111
    {host::PowerState::fault_reaction_active, {0x004F, 0x000F}},   // x0xx 1111
    {host::PowerState::fault, {0x004F, 0x0008}},                   // x0xx 1000
};

PowerStateMachine machine_in(host::PowerState state) {
  PowerStateMachine m;
  if (state == host::PowerState::not_ready_to_switch_on) return m;
  m.initialised();
  if (state == host::PowerState::switch_on_disabled) return m;
  if (state == host::PowerState::fault_reaction_active || state == host::PowerState::fault) {
    m.fail();
    if (state == host::PowerState::fault) m.standstill(false);
    return m;
  }
  m.control(kShutdown, false);
  if (state != host::PowerState::ready_to_switch_on) m.control(kSwitchOn, false);
  if (state == host::PowerState::operation_enabled || state == host::PowerState::quick_stop_active)
    m.control(kEnable, false);
  if (state == host::PowerState::quick_stop_active) m.control(kQuickStop, false);
  return m;
}

host::PowerState after(host::PowerState from, std::uint16_t controlword, bool stays = false) {
  PowerStateMachine m = machine_in(from);
  EXPECT_EQ(m.state(), from);
  m.control(controlword, stays);
  return m.state();
}

TEST(PowerState, EveryStateHasThePatternOfTheStandard) {
  for (const auto& [state, pattern] : kPatterns)
    EXPECT_EQ(host::status_pattern(state) & pattern.mask, pattern.value);
}

TEST(PowerState, NoPatternFitsTwoStates) {
  for (const auto& [state, unused] : kPatterns) {
    int fitting = 0;
    for (const auto& [other, pattern] : kPatterns)
      fitting += (host::status_pattern(state) & pattern.mask) == pattern.value ? 1 : 0;
    EXPECT_EQ(fitting, 1);
  }
}

TEST(PowerState, TransitionsOnCommand) {
  using S = host::PowerState;
  EXPECT_EQ(after(S::switch_on_disabled, kShutdown), S::ready_to_switch_on);        // 2
  EXPECT_EQ(after(S::ready_to_switch_on, kSwitchOn), S::switched_on);               // 3
  EXPECT_EQ(after(S::switched_on, kEnable), S::operation_enabled);                  // 4
  EXPECT_EQ(after(S::ready_to_switch_on, kEnable), S::operation_enabled);           // 3 + 4
  EXPECT_EQ(after(S::operation_enabled, kDisableOperation), S::switched_on);        // 5
  EXPECT_EQ(after(S::switched_on, kShutdown), S::ready_to_switch_on);               // 6
  EXPECT_EQ(after(S::ready_to_switch_on, kDisableVoltage), S::switch_on_disabled);  // 7
  EXPECT_EQ(after(S::ready_to_switch_on, kQuickStop), S::switch_on_disabled);       // 7
  EXPECT_EQ(after(S::operation_enabled, kShutdown), S::ready_to_switch_on);         // 8
  EXPECT_EQ(after(S::operation_enabled, kDisableVoltage), S::switch_on_disabled);   // 9
  EXPECT_EQ(after(S::switched_on, kDisableVoltage), S::switch_on_disabled);         // 10
  EXPECT_EQ(after(S::switched_on, kQuickStop), S::switch_on_disabled);              // 10
  EXPECT_EQ(after(S::operation_enabled, kQuickStop), S::quick_stop_active);         // 11
  EXPECT_EQ(after(S::quick_stop_active, kDisableVoltage), S::switch_on_disabled);   // 12
  EXPECT_EQ(after(S::quick_stop_active, kEnable, true), S::operation_enabled);      // 16
}

TEST(PowerState, TransitionsByThemselves) {
  PowerStateMachine m;
  m.initialised();  // 1
  EXPECT_EQ(m.state(), host::PowerState::switch_on_disabled);
  m = machine_in(host::PowerState::quick_stop_active);
  m.standstill(false);  // 12
  EXPECT_EQ(m.state(), host::PowerState::switch_on_disabled);
  m = machine_in(host::PowerState::quick_stop_active);
  m.standstill(true);
  EXPECT_EQ(m.state(), host::PowerState::quick_stop_active);
  m = machine_in(host::PowerState::fault_reaction_active);
  m.standstill(true);  // 14
  EXPECT_EQ(m.state(), host::PowerState::fault);
}

TEST(PowerState, EveryStateButFaultFallsIntoFaultReaction) {
  for (const auto& [state, unused] : kPatterns) {
    if (state == host::PowerState::fault) continue;
    PowerStateMachine m = machine_in(state);
    m.fail();  // 13
    EXPECT_EQ(m.state(), host::PowerState::fault_reaction_active);
  }
}

TEST(PowerState, ForbiddenCommandsChangeNothing) {
  using S = host::PowerState;
  const std::vector<std::pair<S, std::uint16_t>> forbidden{
      {S::not_ready_to_switch_on, kShutdown},
      {S::not_ready_to_switch_on, kEnable},
      {S::switch_on_disabled, kSwitchOn},
      {S::switch_on_disabled, kEnable},
      {S::switch_on_disabled, kQuickStop},
      {S::switch_on_disabled, kDisableVoltage},
      {S::ready_to_switch_on, kShutdown},
      {S::switched_on, kSwitchOn},
      {S::operation_enabled, kEnable},
      {S::quick_stop_active, kEnable},
      {S::quick_stop_active, kShutdown},
      {S::quick_stop_active, kSwitchOn},
      {S::quick_stop_active, kQuickStop},
      {S::fault_reaction_active, kShutdown},
      {S::fault_reaction_active, kEnable},
      {S::fault, kShutdown},
      {S::fault, kSwitchOn},
      {S::fault, kEnable},
      {S::fault, kDisableVoltage},
      {S::fault, kQuickStop},
  };
  for (const auto& [state, controlword] : forbidden)
    EXPECT_EQ(after(state, controlword), state) << "controlword " << controlword;
}

TEST(PowerState, OnlyTheRisingEdgeOfBit7ResetsAFault) {
  PowerStateMachine m = machine_in(host::PowerState::switched_on);
  m.control(0x80, false);  // risen before there was a fault
  m.fail();
  m.standstill(false);
  m.control(0x80, false);
  EXPECT_EQ(m.state(), host::PowerState::fault);
  m.control(0x00, false);
  m.control(0x80, false);  // 15
  EXPECT_EQ(m.state(), host::PowerState::switch_on_disabled);
}

TEST(PowerState, FaultResetWaitsForTheEndOfTheReaction) {
  PowerStateMachine m = machine_in(host::PowerState::fault_reaction_active);
  m.control(0x80, false);
  EXPECT_EQ(m.state(), host::PowerState::fault_reaction_active);
}

TEST(PowerState, CommandsNeedBit7Low) {
  EXPECT_EQ(after(host::PowerState::switch_on_disabled, 0x86),
            host::PowerState::switch_on_disabled);
  EXPECT_EQ(after(host::PowerState::operation_enabled, 0x80), host::PowerState::operation_enabled);
}

TEST(PowerState, DoNotCareBitsAreNotCaredFor) {
  EXPECT_EQ(after(host::PowerState::switch_on_disabled, 0x0E),
            host::PowerState::ready_to_switch_on);
  EXPECT_EQ(after(host::PowerState::operation_enabled, 0x0D), host::PowerState::switch_on_disabled);
  EXPECT_EQ(after(host::PowerState::operation_enabled, 0x0B), host::PowerState::quick_stop_active);
}

// The walk over the bus: TPDO1 carries the statusword that the controlword of this SYNC led to.
TEST(PowerState, TheDriveWalksUpOverItsPdos) {
  Bench bench;
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
  bench.start_node();
  const std::vector<std::pair<std::uint16_t, std::uint16_t>> walk{
      {kShutdown, 0x0231}, {kSwitchOn, 0x0233}, {kEnable, 0x0237}, {kEnable, 0x1237}};
  for (const auto& [controlword, statusword] : walk) {
    bench.cycle(controlword, 0);
    const hal::CanFrame tpdo = bench.find(0x183);
    EXPECT_EQ(tpdo.data[4] | tpdo.data[5] << 8, statusword);
  }
}

}  // namespace
}  // namespace volcomp::sim
