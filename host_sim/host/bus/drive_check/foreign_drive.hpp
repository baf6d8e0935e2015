#pragma once
// What is known of somebody else's CANopen drive: read over SDO, or from its EDS. Nothing is
// written to it here.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/canopen/nmt.hpp"
#include "firmware/canopen/pdo.hpp"
#include "host_sim/host/bus/device_files/eds_file.hpp"
#include "host_sim/host/bus/drive_check/tried_mappings.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// 1000h: the device profile stands in the lower half.
[[nodiscard]] constexpr bool is_cia402(std::uint64_t device_type) {
  return (device_type & 0xFFFFU) == 402;
}

struct ForeignValue {
  // Of the object; nothing: it is there, but what it holds was not given or could not be read.
  std::optional<std::uint64_t> number;
  std::size_t bytes = 0;  // of the number; 0: not known
  std::string text;
};

// One PDO as it is set up now.
struct ForeignPdo {
  std::size_t number = 1;  // from 1
  std::uint32_t cob_id = canopen::kPdoInvalid;
  std::uint8_t type = canopen::kEventType;
  Mapping mapping;

  [[nodiscard]] bool valid() const { return (cob_id & canopen::kPdoInvalid) == 0; }
  [[nodiscard]] std::uint16_t id() const {
    return static_cast<std::uint16_t>(cob_id & hal::kMaxCanId);
  }
  [[nodiscard]] bool maps(std::uint16_t index) const;
};

// What 60B0h did to the demand value when it was written by SDO.
enum class MovedDemand : std::uint8_t {
  unknown,    // nothing, or nothing regular: most drives let 6062h follow 6064h while disabled
  as_named,   // it moved by what was written
  otherwise,  // it moved, but not so
};

struct ForeignDrive {
  std::uint8_t node = 1;
  std::map<EdsFile::Key, ForeignValue> objects;
  std::vector<ForeignPdo> receive;
  std::vector<ForeignPdo> transmit;
  // Who knows where an object may be mapped; over SDO nobody says without trying.
  std::optional<EdsFile> rules;
  std::optional<TriedMappings> tried;
  std::optional<MovedDemand> moved;

  // Whether the low half of 1000h says so; of another device nothing more is read over SDO.
  [[nodiscard]] bool is_cia402() const;
  [[nodiscard]] bool has(std::uint16_t index, std::uint8_t sub = 0) const;
  [[nodiscard]] std::optional<std::uint64_t> number(std::uint16_t index,
                                                    std::uint8_t sub = 0) const;
  [[nodiscard]] std::string text(std::uint16_t index) const;
  // Whether an object that is there may be mapped; nothing: only trying tells.
  [[nodiscard]] std::optional<bool> may_map(canopen::PdoKind kind, std::uint16_t index) const;
  // The same for a whole mapping, by trial or by the EDS.
  [[nodiscard]] std::optional<bool> may_map(canopen::PdoKind kind, const Mapping& entries) const;
  // Whether a PDO of that kind takes transmission type 1: its values act, or are, those of SYNC.
  [[nodiscard]] std::optional<bool> may_come_at_sync(canopen::PdoKind kind) const;
  // How many nodes it can watch by their heartbeats.
  [[nodiscard]] std::size_t heartbeat_consumers() const;
};

// Called before every read, with how many there were and how many there will be at most.
using ReadProgress = std::function<void(std::size_t done, std::size_t most)>;

// Throws UserError when the drive does not answer, or stops answering.
[[nodiscard]] ForeignDrive read_drive(NodeClient& client, const ReadProgress& progress = {});
// As it is after power-on.
[[nodiscard]] ForeignDrive read_drive(EdsFile eds, std::uint8_t node_id);

}  // namespace volcomp::host
