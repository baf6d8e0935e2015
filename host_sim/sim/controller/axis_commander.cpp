#include "host_sim/sim/controller/axis_commander.hpp"

#include <utility>

#include "host_sim/host/bus/cia402_status.hpp"

namespace volcomp::sim {
namespace {

// Control words (CiA 402-2, table 28).
constexpr std::uint16_t kDisableVoltage = 0x00;
constexpr std::uint16_t kQuickStop = 0x02;
constexpr std::uint16_t kShutdown = 0x06;
constexpr std::uint16_t kSwitchOn = 0x07;
constexpr std::uint16_t kEnable = 0x0F;
constexpr std::uint16_t kStartHoming = 0x1F;
constexpr std::uint16_t kFaultReset = 0x80;

constexpr std::uint16_t kRetry = 50;  // cycles between two attempts that need a rising edge

host::PowerState state_of(std::uint16_t status) {
  return static_cast<host::PowerState>(status & 0x6FU);
}

// The control word that leads one state further towards operation enabled (CiA 402-2, table 33).
std::uint16_t next_control(std::uint16_t status) {
  switch (state_of(status)) {
    case host::PowerState::ready_to_switch_on:
      return kSwitchOn;
    case host::PowerState::switched_on:
    case host::PowerState::operation_enabled:
      return kEnable;
    default:
      return kShutdown;
  }
}

// Wraps like the 32-bit counter of the drive.
std::int32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

}  // namespace

void AxisCommander::drive_lost() { *this = {}; }

std::int32_t AxisCommander::standing_at() const { return difference(actual_, held_); }

void AxisCommander::step(std::int32_t path) {
  wanted_mode_ = 0;
  if (!heard_) {
    control_ = 0;
    return;
  }
  const bool enabled = state_of(status_) == host::PowerState::operation_enabled;
  const bool fault = (status_ & 0x4FU) == status_pattern(host::PowerState::fault);
  const bool referenced = (status_ & host::kStatusReferenced) != 0;
  if (fault) {
    // Reset works on a rising edge.
    control_ = ++waited_ % kRetry == 0 ? kFaultReset : kShutdown;
  } else {
    control_ = next_control(status_);
  }
  // A drive whose 605Ah says so stays in quick stop active: its axis stands, so it may let go.
  if (state_of(status_) == host::PowerState::quick_stop_active && at_rest_ > kRetry)
    control_ = kDisableVoltage;
  if (!may_enable_ && !enabled && control_ == kEnable) control_ = kSwitchOn;
  if (std::exchange(stops_, false) && enabled) control_ = kQuickStop;
  const bool was_following = following_;
  following_ = enabled && referenced && mode_ == kCyclicPosition;
  if (enabled && !following_) {
    const std::int8_t mode = referenced ? kCyclicPosition : kHomingMode;
    if (mode_ != mode) wanted_mode_ = mode;
    const bool homes = mode_ == kHomingMode && !referenced;
    if (homes && ++waited_ % kRetry > 1) control_ = kStartHoming;
  } else if (!fault) {
    waited_ = 0;
  }
  if (following_ && was_following) {
    target_ = path;
  } else {
    target_ = standing_at();
  }
}

}  // namespace volcomp::sim
