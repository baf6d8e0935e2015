// A diagnosis as text for people and for programs.

#include <fmt/format.h>

#include "comp/tick/status_text.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/node/store/storage.hpp"
#include "host_sim/host/bus/cia402_status.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using canopen::ErrorCode;
using canopen::NmtState;

constexpr volcomp::StatusBit status_bit(std::size_t number) {
  return static_cast<volcomp::StatusBit>(1U << number);
}

const char* words(NmtState state) {
  switch (state) {
    case NmtState::boot_up:
      return "starting";
    case NmtState::stopped:
      return "STOPPED";
    case NmtState::operational:
      return "OPERATIONAL";
    case NmtState::pre_operational:
      return "PRE-OPERATIONAL, waits to be started";
  }
  return "unknown";
}

const char* words(node::NodeState state) {
  switch (state) {
    case node::NodeState::idle:
      return "idle";
    case node::NodeState::no_tables:
      return "has no tables to compensate with";
    case node::NodeState::waiting:
      return "waits for the drives to report the offsets they hold";
    case node::NodeState::compensating:
      return "compensates every axis";
    case node::NodeState::degraded:
      return "compensates, but not every axis as it should";
    case node::NodeState::overdue:
      return "is about to restart, its background hangs; corrections are ramped to zero";
  }
  return "unknown";
}

const char* words(node::TableState state) {
  switch (state) {
    case node::TableState::empty:
      return "nothing was sent";
    case node::TableState::receiving:
      return "being sent, or broken off";
    case node::TableState::received:
      return "complete, not yet checked";
    case node::TableState::valid:
      return "checked and good, not active";
    case node::TableState::armed:
      return "ready to be activated";
    case node::TableState::active:
      return "active";
    case node::TableState::refused:
      return "refused";
  }
  return "unknown";
}

const char* words(hal::ResetCause cause) {
  switch (cause) {
    case hal::ResetCause::power_on:
      return "power was switched on";
    case hal::ResetCause::request:
      return "on request";
    case hal::ResetCause::watchdog:
      return "by the watchdog";
    case hal::ResetCause::fault:
      return "after a fault of the processor";
  }
  return "unknown";
}

const char* saved_words(node::StoreResult result) {
  return result == node::StoreResult::nothing_stored ? "There was none." : sentence(result);
}

std::string tables_line(const Diagnosis& d) {
  if (d.tables.crc == 0) return "none";
  return fmt::format("CRC-32 {:08X}, sequence number {}", d.tables.crc, d.tables.sequence);
}

std::string machine_line(const Diagnosis& d) {
  return d.machine_id == 0 ? "takes tables of any machine"
                           : fmt::format("takes tables of machine {} only", d.machine_id);
}

std::string describe_axis(const AxisDiagnosis& a) {
  const char* const unit = a.rotary ? "µrad" : "µm";
  std::string text = fmt::format(
      "axis {}: {}\n  drive: node {}, {}\n  offset {:.3f} {}, largest so far {:.3f} {}\n",
      a.letter != '\0' ? std::string(1, a.letter) : std::to_string(a.number),
      describe_status(a.status), a.drive, describe_drive(a.drive_status), a.offset, unit,
      a.largest_offset, unit);
  for (std::size_t bit = 1; bit < a.began.size(); ++bit) {
    if (a.began[bit] == 0) continue;
    text += fmt::format("  {} x {}\n", a.began[bit], words(status_bit(bit)));
  }
  return text;
}

nlohmann::json axis_json(const AxisDiagnosis& a) {
  nlohmann::json began;
  for (std::size_t bit = 0; bit < a.began.size(); ++bit)
    began[code(status_bit(bit))] = a.began[bit];
  const char* const unit = a.rotary ? "µrad" : "µm";
  return {
      {"axis", a.number},   {"letter", a.letter != '\0' ? std::string(1, a.letter) : std::string()},
      {"drive", a.drive},   {"drive_status", a.drive_status},
      {"status", a.status}, {"status_text", describe_status(a.status)},
      {"offset", a.offset}, {"largest_offset", a.largest_offset},
      {"unit", unit},       {"began", began}};
}

}  // namespace

std::string describe_status(std::uint16_t status) {
  std::string text;
  for (std::size_t bit = 0; bit < kStatusBits; ++bit) {
    if ((unsigned{status} >> bit & 1U) == 0) continue;
    text += (text.empty() ? "" : "; ") + std::string(words(status_bit(bit)));
  }
  return text.empty() ? "not computed yet" : text;
}

std::string describe_drive(std::uint16_t status_word) {
  static constexpr std::array<std::pair<PowerState, const char*>, 8> kStates{{
      {PowerState::not_ready_to_switch_on, "starting"},
      {PowerState::switch_on_disabled, "switched off, switching on disabled"},
      {PowerState::ready_to_switch_on, "ready to switch on"},
      {PowerState::switched_on, "switched on, not enabled"},
      {PowerState::operation_enabled, "enabled"},
      {PowerState::quick_stop_active, "quick stop"},
      {PowerState::fault_reaction_active, "stopping because of a fault"},
      {PowerState::fault, "fault"},
  }};
  // Quick stop (bit 5) means nothing where the pattern of the state leaves it open.
  constexpr std::uint16_t kState = 0x006F;
  constexpr std::uint16_t kStateWithoutQuickStop = 0x004F;
  for (const auto& [state, name] : kStates) {
    const bool open = state == PowerState::not_ready_to_switch_on ||
                      state == PowerState::switch_on_disabled ||
                      state == PowerState::fault_reaction_active || state == PowerState::fault;
    const std::uint16_t mask = open ? kStateWithoutQuickStop : kState;
    if ((status_word & mask) == (status_pattern(state) & mask))
      return fmt::format("{} (6041h = {:04X}h)", name, status_word);
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

std::string describe(const Diagnosis& d) {
  std::vector<std::pair<std::string, std::string>> lines;
  const auto line = [&lines](const char* what, const std::string& value) {
    lines.emplace_back(what, value);
  };
  line("network state:", d.nmt ? words(*d.nmt) : "unknown, no heartbeat within 1 s");
  line("state:", words(d.state));
  line("active tables:", tables_line(d));
  line("image last sent:", words(d.table_state));
  if (!d.refusal.empty()) line("last refusal:", d.refusal);
  line("machine:", machine_line(d));
  line("last start:", words(d.start));
  line("store at the start:", sentence(d.stored));
  line("last save or restore:", saved_words(d.saved));
  line("cycles:", fmt::format("{}, {} of them incomplete at the deadline, {} cut short by SYNC",
                              d.cycles, d.deadline_missed, d.cycles_skipped));
  line("SYNC:", fmt::format("{} missed, {} of another producer", d.sync_missed, d.sync_foreign));
  line("frames lost:", std::to_string(d.frames_lost));
  line("tables:", fmt::format("{} times activated, {} times refused", d.activations, d.rejections));
  if (d.thermal) add_lines(*d.thermal, lines);
  line("errors now:", d.error_register == 0
                          ? std::string("none")
                          : fmt::format("error register {:02X}h", d.error_register));
  line("error history:", d.errors.empty() ? "empty" : "newest first");
  std::string text = fmt::format("node {}: {}, hardware {}, software {}\n", d.node_id, d.name,
                                 d.hardware_version, d.software_version) +
                     text_of_section(list_section("", lines));
  for (const std::uint32_t field : d.errors)
    text += fmt::format("  {}\n", describe_error(field));
  if (d.axes.empty()) text += "no axis has a drive\n";
  for (const AxisDiagnosis& axis : d.axes)
    text += describe_axis(axis);
  if (d.strokes) text += describe(*d.strokes);
  return text;
}

nlohmann::json to_json(const Diagnosis& d) {
  nlohmann::json errors = nlohmann::json::array();
  for (const std::uint32_t field : d.errors)
    errors.push_back({{"field", field}, {"text", describe_error(field)}});
  nlohmann::json axes = nlohmann::json::array();
  for (const AxisDiagnosis& axis : d.axes)
    axes.push_back(axis_json(axis));
  return {{"node_id", d.node_id},
          {"name", d.name},
          {"hardware_version", d.hardware_version},
          {"software_version", d.software_version},
          {"network_state", d.nmt ? words(*d.nmt) : nullptr},
          {"state", words(d.state)},
          {"table_state", words(d.table_state)},
          {"active_crc", fmt::format("{:08X}", d.tables.crc)},
          {"active_sequence", d.tables.sequence},
          {"machine_id", d.machine_id},
          {"refusal", d.refusal},
          {"error_register", d.error_register},
          {"errors", errors},
          {"cycles", d.cycles},
          {"deadline_missed", d.deadline_missed},
          {"cycles_skipped", d.cycles_skipped},
          {"sync_missed", d.sync_missed},
          {"sync_foreign", d.sync_foreign},
          {"activations", d.activations},
          {"rejections", d.rejections},
          {"stored", sentence(d.stored)},
          {"saved", saved_words(d.saved)},
          {"start", words(d.start)},
          {"frames_lost", d.frames_lost},
          {"axes", axes},
          {"strokes", d.strokes ? to_json(*d.strokes) : nlohmann::json()},
          {"thermal", d.thermal ? to_json(*d.thermal) : nlohmann::json()}};
}

}  // namespace volcomp::host
