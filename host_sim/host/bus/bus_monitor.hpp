#pragma once
// Follows a machine by listening to its bus: which nodes are alive, what every axis does, what the
// node adds, which errors occur. Never sends.
//
// Messages and signals are those of device_files/bus_messages.hpp.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware/canopen/nmt.hpp"
#include "hal/can_port.hpp"
#include "host_sim/host/bus/device_files/bus_messages.hpp"

namespace volcomp::host {

struct StationSeen {
  std::string name;  // "controller", "node", "drive X"
  std::uint8_t id = 0;
  std::optional<canopen::NmtState> state;  // of the last heartbeat
  std::uint64_t heard_us = 0;              // when that came
  std::uint64_t frames = 0;                // of any kind in this period
  bool silent = false;                     // no heartbeat for longer than it used to take
};

// State of one axis; what was never seen is empty. Positions and offsets in the unit of the axis.
struct AxisSeen {
  char letter = '\0';
  std::uint8_t drive = 0;
  std::string unit;  // "nm" or "deg" of the wire's signals
  std::optional<double> target;
  std::optional<double> actual;  // contains the offset
  std::optional<double> offset;  // sent by the node
  std::optional<std::uint16_t> status_word;
  std::optional<std::uint16_t> edges;  // of the touch probe
  std::uint64_t lost = 0;              // cycles of this period without one of its cyclic frames
};

struct NodeSeen {
  std::string state;  // in words
  std::uint32_t active_crc = 0;
  std::uint16_t status = 0;  // of all axes together
};

struct SyncSeen {
  std::uint64_t count = 0;  // in this period
  std::uint64_t lost = 0;   // gaps of its counter
  double mean_us = 0.0;
  double least_us = 0.0;
  double most_us = 0.0;
};

struct EmergencySeen {
  double time_s = 0.0;
  std::string who;
  std::string text;
};

// One period of watching.
struct BusSnapshot {
  double time_s = 0.0;    // since the first frame, at the end of the period
  double period_s = 0.0;  // how long it was
  std::uint64_t frames = 0;
  double load = 0.0;  // share of 1 Mbit/s, with the stuff bits there were
  SyncSeen sync;
  std::vector<StationSeen> stations;
  std::optional<NodeSeen> node;
  std::vector<AxisSeen> axes;
  std::vector<EmergencySeen> emergencies;  // of this period, the last 20
  std::uint64_t emergency_count = 0;
};

class BusMonitor {
 public:
  // Throws UserError as bus_messages.
  explicit BusMonitor(const BusSettings& settings);

  // In the order of time.
  void take(std::uint64_t time_us, const hal::CanFrame& frame);
  // Returns what was seen since the last call; a new period begins.
  [[nodiscard]] BusSnapshot snapshot(std::uint64_t now_us);

 private:
  struct Heartbeat {
    canopen::NmtState state{};
    std::uint64_t heard_us = 0;
    std::uint64_t longest_us = 0;  // between two of them, since it was silent last
  };
  struct Cyclic {
    bool known = false;  // seen in an earlier cycle
    bool seen = false;   // in this one
  };
  struct Axis {
    AxisSeen seen;
    std::array<Cyclic, 3> cyclic;  // command, actual, offset
  };

  void take_sync(std::uint64_t time_us, const hal::CanFrame& frame);
  void take_heartbeat(std::uint8_t id, std::uint64_t time_us, const hal::CanFrame& frame);
  void take_emergency(std::uint8_t id, std::uint64_t time_us, const hal::CanFrame& frame);
  static void take_axis(Axis& axis, const BusMessage& message, const hal::CanFrame& frame);
  [[nodiscard]] StationSeen station(const std::string& name, std::uint8_t id,
                                    std::uint64_t now_us) const;

  BusSettings settings_;
  std::map<std::uint16_t, BusMessage> message_;  // by identifier
  std::vector<Axis> axis_;
  std::map<std::uint8_t, Heartbeat> heartbeat_;
  std::map<std::uint8_t, std::uint64_t> frames_of_;
  std::optional<NodeSeen> node_;
  BusSnapshot period_;
  std::optional<std::uint64_t> first_us_;
  std::uint64_t period_begin_us_ = 0;
  std::uint64_t bits_ = 0;
  std::optional<std::uint64_t> last_sync_us_;
  static constexpr int kMostCounter = 240;  // of 1019h (CiA 301)
  int last_counter_ = 0;                    // 0: none
  int most_counter_ = kMostCounter;
};

[[nodiscard]] std::string describe(const BusSnapshot& snapshot);
[[nodiscard]] nlohmann::json to_json(const BusSnapshot& snapshot);

}  // namespace volcomp::host
