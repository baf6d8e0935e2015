// Single values of a diagnosis in words.

#include <fmt/format.h>

#include "comp/tick/status_text.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/node/store/storage.hpp"
#include "host_sim/host/bus/cia402_status.hpp"
#include "host_sim/host/bus/diagnosis.hpp"

namespace volcomp::host {
namespace {

using canopen::ErrorCode;

constexpr volcomp::StatusBit status_bit(std::size_t number) {
  return static_cast<volcomp::StatusBit>(1U << number);
}

}  // namespace

const char* words(hal::ResetCause cause) {
  constexpr std::array kCauses{"power was switched on", "on request", "by the watchdog",
                               "after a fault of the processor"};
  return word_of(kCauses, static_cast<std::size_t>(cause));
}

std::string describe_status(std::uint16_t status) {
  std::string text;
  for (std::size_t bit = 0; bit < kStatusBits; ++bit) {
    if ((unsigned{status} >> bit & 1U) == 0) continue;
    text += (text.empty() ? "" : "; ") + std::string(words(status_bit(bit)));
  }
  return text.empty() ? "not computed yet" : text;
}

std::string describe_drive(std::uint16_t status_word) {
  constexpr std::uint16_t kState = 0x006F;
  // Quick stop (bit 5) means nothing where the pattern of the state leaves it open.
  constexpr std::uint16_t kOpen = 0x004F;
  struct State {
    PowerState state;
    std::uint16_t mask;
    const char* name;
  };
  static constexpr std::array<State, 8> kStates{{
      {PowerState::not_ready_to_switch_on, kOpen, "starting"},
      {PowerState::switch_on_disabled, kOpen, "switched off, switching on disabled"},
      {PowerState::ready_to_switch_on, kState, "ready to switch on"},
      {PowerState::switched_on, kState, "switched on, not enabled"},
      {PowerState::operation_enabled, kState, "enabled"},
      {PowerState::quick_stop_active, kState, "quick stop"},
      {PowerState::fault_reaction_active, kOpen, "stopping because of a fault"},
      {PowerState::fault, kOpen, "fault"},
  }};
  for (const State& s : kStates) {
    if ((status_word & s.mask) == (status_pattern(s.state) & s.mask))
      return fmt::format("{} (6041h = {:04X}h)", s.name, status_word);
  }
  return fmt::format("in no state of CiA 402 (6041h = {:04X}h)", status_word);
}

std::string describe_error(std::uint32_t field) {
  const auto code = static_cast<ErrorCode>(field & 0xFFFFU);
  const std::uint32_t source = field >> 16U & 0xFFU;
  std::string where;
  switch (code) {
    case ErrorCode::heartbeat:
      where = fmt::format("node {}: ", source);
      break;
    case ErrorCode::rpdo_length:
      where = fmt::format("RPDO {}: ", source);
      break;
    case ErrorCode::temperature_held:
      where = fmt::format("temperature {}: ", source - 1);
      break;
    case ErrorCode::table_refused:
      if (source != 0) where = fmt::format("axis {}: ", static_cast<char>(source));
      break;
    case ErrorCode::rpdo_timeout:
    case ErrorCode::axis_not_referenced:
    case ErrorCode::axis_implausible:
    case ErrorCode::axis_clamped:
    case ErrorCode::axis_out_of_range:
    case ErrorCode::no_authority:
    case ErrorCode::offset_not_confirmed:
      where = fmt::format("axis {}: ", source);
      break;
    case ErrorCode::memory_damaged:
      if (source != 0) where = fmt::format("axis {}: ", source);
      break;
    case ErrorCode::store_failed:
    case ErrorCode::parameters_lost:
      where = fmt::format("{} ", node::sentence(static_cast<node::StoreResult>(source)));
      break;
    case ErrorCode::unexpected_reset:
      where = fmt::format("{}: ", words(static_cast<hal::ResetCause>(source)));
      break;
    default:
      break;
  }
  return fmt::format("{}{} [{:04X}h]", where, canopen::sentence(code), field & 0xFFFFU);
}

}  // namespace volcomp::host
