#pragma once
// The motion controller as a CANopen manager: NMT master, configuration manager, SYNC and heartbeat
// producer. It configures and starts drives and compensation node, restarts any that was absent,
// and lets the axes move only while all of them work.

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "comp/tables/thermal.hpp"
#include "firmware/canopen/nmt.hpp"
#include "host_sim/host/bus/bus_settings.hpp"
#include "host_sim/host/bus/probe_setup.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"
#include "host_sim/sim/controller/axis_commander.hpp"
#include "host_sim/sim/controller/node_probe.hpp"

namespace volcomp::sim {

// Another node as the motion controller sees it: whether it is there, configured and running.
struct Station {
  enum class Phase : std::uint8_t {
    absent,       // silent
    configuring,  // its objects are being written
    running,      // started
    failed,       // refused its configuration; tried again after a while
  };

  Station(std::uint8_t node, std::string label) : id(node), name(std::move(label)), channel(node) {}

  std::uint8_t id;
  std::string name;
  host::SdoChannel channel;
  Phase phase = Phase::absent;
  canopen::NmtState state = canopen::NmtState::boot_up;
  std::uint64_t last_heard_us = 0;
  std::uint64_t retry_us = 0;  // when to try again what failed
  std::uint32_t boots = 0;
  bool refused = false;    // by us, in this attempt: its units are not those of the machine file
  std::string refusal;     // why the last attempt failed, until one succeeds
  int not_started = 0;     // consecutive heartbeats that are not OPERATIONAL
  bool confirmed = false;  // its mapping has been read back for the node (2037h)
};

// One emergency message as received.
struct EmergencyRecord {
  std::uint64_t time_us = 0;
  std::uint8_t node = 0;
  std::uint16_t code = 0;
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> info{};
};

// Content of the node's status PDO.
struct NodeReport {
  std::uint32_t active_crc = 0;
  std::uint8_t state = 0;         // node::NodeState
  std::uint8_t sync_counter = 0;  // of the cycle it belongs to
  std::uint16_t any_status = 0;   // StatusBit of all axes together
  std::uint64_t count = 0;        // reports so far
};

// The reports of a drive on its touch probe input.
struct ProbeReport {
  std::uint16_t status = 0;   // 60B9h
  std::int32_t position = 0;  // 60BAh
  std::uint32_t time_ns = 0;  // 60D1h
  std::uint16_t edges = 0;    // 60D5h
  std::uint64_t latches = 0;  // reports of 60BAh and 60D1h so far
  int stored_cycles = 0;      // for which 60B9h has said that an edge is stored
};

class BusController {
 public:
  // `image`: tables for the node; empty: none.
  BusController(host::BusSettings settings, std::vector<std::uint8_t> image);

  // --- the loop of canopen/exchange.hpp
  void receive(const hal::CanFrame& frame, std::uint64_t now_us);
  void poll(std::uint64_t now_us);
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t now_us);
  void taken(std::uint64_t now_us);
  // As of canopen::DeviceBase, for SimulatedBus::attach_resting().
  static bool heeds(const hal::CanFrame& /*frame*/) { return true; }
  [[nodiscard]] std::uint64_t sends_at_us() const;
  [[nodiscard]] std::uint64_t rests_until_us() const;

  // --- once per cycle
  // Targets in drive units: sent as 607Ah after a SYNC, taken by the drives at the next.
  void send_targets(const std::vector<std::int32_t>& path);
  // What is done at the targets of this cycle, for a node that watches strokes (201Ah).
  void send_process_state(const host::ProcessState& state);
  void send_sync();
  // How warm the axes are, deg C by input; not a number: no sensor.
  void send_temperatures(const Temperatures& temperatures);
  // The date as CANopen TIME.
  void send_time(std::int64_t unix_s);

  // Resets every node on the bus; each that boots is configured and started.
  void power_on(std::uint64_t now_us);
  // Tables to work with from now on; downloaded at once to a node that runs.
  void load_tables(std::vector<std::uint8_t> image);
  // Settings of the node's probe from now on, written at once to a node that runs.
  void use_probe(const host::NodeProbe& probe);
  // What the node has made of touches since the last call.
  [[nodiscard]] std::vector<NodePoint> take_points() { return points_.take_points(); }
  // Everything else that is read and written of the node's objects.
  [[nodiscard]] host::SdoChannel& node_objects() { return stations_.back().channel; }

  // Every node runs, every axis follows its path, the node compensates (or was given no tables).
  [[nodiscard]] bool motion_allowed() const;
  // What is missing for that, as text.
  [[nodiscard]] std::string trouble() const;

  [[nodiscard]] std::uint8_t sync_counter() const { return counter_; }
  [[nodiscard]] const NodeReport& report() const { return report_; }
  // The node has reported since the last SYNC: by its counter where SYNC has one.
  [[nodiscard]] bool sync_answered() const {
    return counter_ == 0 ? report_.count != reports_at_sync_ : report_.sync_counter == counter_;
  }
  [[nodiscard]] const AxisCommander& axis(std::size_t a) const { return axis_.at(a); }
  [[nodiscard]] const ProbeReport& probe(std::size_t a) const { return probe_.at(a); }
  [[nodiscard]] const Station& node() const { return stations_.back(); }
  [[nodiscard]] const std::vector<Station>& stations() const { return stations_; }  // drives, node
  [[nodiscard]] const std::vector<EmergencyRecord>& emergencies() const { return emergencies_; }
  [[nodiscard]] const host::BusSettings& settings() const { return settings_; }

 private:
  void command(canopen::NmtCommand what, std::uint8_t node);
  [[nodiscard]] Station* station(std::uint8_t id);
  [[nodiscard]] bool is_drive(const Station& s) const { return s.id != settings_.node; }
  void take_heartbeat(Station& s, std::uint8_t state, std::uint64_t now_us);
  void take_process_data(const hal::CanFrame& frame);
  void take_drive_pdo(std::size_t a, const hal::CanFrame& frame);
  void supervise(Station& s, std::uint64_t now_us);
  [[nodiscard]] std::uint64_t supervises_at_us(const Station& s) const;
  void reset_silent(Station& s, std::uint64_t now_us);
  void retry_tables(Station& s, std::uint64_t now_us);
  void send_latest(const hal::CanFrame& frame);
  void configure(Station& s);
  void check_scaling(Station& s, std::size_t axis);
  void configure_drive(Station& s, std::size_t axis);
  [[nodiscard]] bool latches_once(std::size_t axis) const;
  void arm_again();
  void configure_node(host::SdoChannel& sdo);
  void tell_held_offset(std::size_t axis);
  void tell_held_offsets(const Station& started);
  void confirm_mapping(std::size_t axis);
  void take_offsets_to_add(const hal::CanFrame& frame);
  void watch_node();
  void queue_tables(host::SdoChannel& sdo);
  void take_refusal(Station& s);
  void set_modes();
  void set_mode(host::SdoChannel& sdo, std::size_t axis, std::int8_t mode);

  host::BusSettings settings_;
  std::vector<std::uint8_t> image_;
  std::uint32_t image_crc_ = 0;
  std::optional<host::NodeProbe> node_probe_;
  PointReader points_;
  std::vector<AxisCommander> axis_;
  std::vector<ProbeReport> probe_;
  std::vector<Station> stations_;
  std::deque<hal::CanFrame> outgoing_;
  host::SdoChannel* offered_sdo_ = nullptr;
  std::vector<EmergencyRecord> emergencies_;
  NodeReport report_;
  std::uint64_t reports_at_sync_ = 0;
  std::vector<std::int32_t> added_;  // to the targets of axes that the controller corrects
  int served_ = 0;                   // cycles in a row in which the node forwarded to every axis
  std::uint64_t next_heartbeat_us_ = 0;
  std::uint8_t counter_ = 0;
  int node_requests_ = 0;  // SDO frames to the running node in this cycle
};

}  // namespace volcomp::sim
