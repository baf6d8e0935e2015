#pragma once
// Reads the state of a compensation node over SDO and describes it in plain sentences.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/tick/tick_types.hpp"
#include "firmware/node/node_objects.hpp"
#include "firmware/node/store/storage.hpp"
#include "hal/reset_cause.hpp"
#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/host/bus/stroke_diagnosis.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/bus/thermal_diagnosis.hpp"

namespace volcomp::host {

struct AxisDiagnosis {
  std::size_t number = 0;  // from 1
  char letter = '\0';      // '\0' without tables
  std::uint8_t drive = 0;  // node id
  bool rotary = false;
  std::uint16_t drive_status = 0;  // 6041h
  std::uint16_t status = 0;        // StatusBit
  double offset = 0.0;             // µm, or µrad of a rotary axis; so is the next
  double largest_offset = 0.0;
  std::array<std::uint16_t, kStatusBits> began{};  // how often each status bit began
};

struct Diagnosis {
  std::uint8_t node_id = 0;
  std::string name;
  std::string hardware_version;
  std::string software_version;
  std::optional<canopen::NmtState> nmt;  // nothing: no heartbeat within a second
  std::uint8_t error_register = 0;
  std::vector<std::uint32_t> errors;  // 1003h, newest first
  node::NodeState state{};
  node::TableState table_state{};
  ActiveTables tables;
  std::uint32_t machine_id = 0;  // 0: any
  std::string refusal;           // the last one; empty without
  std::uint32_t cycles = 0;
  std::uint32_t deadline_missed = 0;
  std::uint32_t cycles_skipped = 0;
  std::uint32_t sync_missed = 0;
  std::uint32_t sync_foreign = 0;
  std::uint32_t activations = 0;
  std::uint32_t rejections = 0;
  node::StoreResult stored{};       // of the start
  node::StoreResult saved{};        // of the last save or restore; nothing_stored: there was none
  hal::ResetCause start{};          // why the processor started
  std::uint32_t frames_lost = 0;    // before the node saw them
  std::vector<AxisDiagnosis> axes;  // those with a drive
  std::optional<StrokeDiagnosis> strokes;   // of a node that knows them
  std::optional<ThermalDiagnosis> thermal;  // the same
};

// Throws as NodeClient::read.
[[nodiscard]] Diagnosis diagnose(NodeClient& client);

[[nodiscard]] std::string describe(const Diagnosis& diagnosis);
[[nodiscard]] nlohmann::json to_json(const Diagnosis& diagnosis);

// One field of 1003h: the error and its source.
[[nodiscard]] std::string describe_error(std::uint32_t field);
// Describes the conditions of an axis; "corrected" when there are none.
[[nodiscard]] std::string describe_status(std::uint16_t status);
// Describes the state of a drive from 6041h (CiA 402-2).
[[nodiscard]] std::string describe_drive(std::uint16_t status_word);

}  // namespace volcomp::host
