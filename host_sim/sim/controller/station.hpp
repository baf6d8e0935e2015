#pragma once
// Another node as the motion controller sees it: whether it is there, configured and running.

#include <cstdint>
#include <string>

#include "firmware/canopen/nmt.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::sim {

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
  bool refused = false;  // by us, in this attempt: its units are not those of the machine file
  std::string refusal;   // why the last attempt failed, until one succeeds
  int not_started = 0;   // consecutive heartbeats that are not OPERATIONAL
};

// One emergency message as received.
struct EmergencyRecord {
  std::uint64_t time_us = 0;
  std::uint8_t node = 0;
  std::uint16_t code = 0;
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> info{};
};

}  // namespace volcomp::sim
