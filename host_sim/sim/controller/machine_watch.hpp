#pragma once
// Observes a machine under compensation once per control period: statistics of a run, a live page.
// Read-only.

#include <cstdint>
#include <memory>
#include <optional>

#include "host_sim/host/machine/axis_kinds.hpp"

namespace volcomp::sim {

// Run-time units (nm or 2^-40 turn) unless noted otherwise.
struct AxisSnapshot {
  char letter = '\0';
  bool rotary = false;
  std::int64_t target = 0;                         // without the offset
  std::int64_t offset = 0;                         // as taken by the drive
  double position = 0.0;                           // of the encoder, offset included; mm or rad
  std::uint64_t latches = 0;                       // of the touch probe, so far
  std::optional<std::uint16_t> drive_status;       // 6041h
  std::optional<std::uint16_t> correction_status;  // StatusBit; none: the node is elsewhere
};

struct BusState {
  std::uint64_t now_ns = 0;
  std::uint64_t busy_ns = 0;
  std::uint64_t frames = 0;
  std::uint64_t emergencies = 0;
  std::uint8_t node_phase = 0;  // Station::Phase
  std::uint8_t node_state = 0;  // node::NodeState
  std::uint16_t any_status = 0;
  std::uint32_t active_crc = 0;
  // Counters of a node in this process.
  std::optional<std::uint32_t> deadline_missed;
  std::optional<std::uint32_t> sync_missed;
};

struct MachineSnapshot {
  std::uint64_t cycle = 0;  // control periods of this machine so far, from 1
  double period_s = 0.0;
  std::size_t axes = 0;
  std::array<AxisSnapshot, host::kMostAxes> axis{};
  std::optional<BusState> bus;  // none: the integrated form
};

// Of one machine, by the thread that moves it.
class MachineObserver {
 public:
  MachineObserver() = default;
  MachineObserver(const MachineObserver&) = delete;
  MachineObserver& operator=(const MachineObserver&) = delete;
  virtual ~MachineObserver() = default;

  // After every control period.
  virtual void cycle(const MachineSnapshot& snapshot) = 0;
};

class MachineWatch {
 public:
  MachineWatch() = default;
  MachineWatch(const MachineWatch&) = delete;
  MachineWatch& operator=(const MachineWatch&) = delete;
  virtual ~MachineWatch() = default;

  // A machine comes into being; it ends with its observer. By any thread.
  [[nodiscard]] virtual std::unique_ptr<MachineObserver> enter() = 0;
};

}  // namespace volcomp::sim
