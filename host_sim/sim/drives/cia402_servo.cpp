// The servo side of a Cia402Drive: from target and offset to a moving axis, once per period.

#include <algorithm>
#include <cstdlib>

#include "host_sim/sim/drives/cia402_drive.hpp"

namespace volcomp::sim {
namespace {

constexpr auto kTargetMissing = static_cast<canopen::ErrorCode>(0x8250);  // CiA 301: RPDO timeout
constexpr auto kBeyondLimit = static_cast<canopen::ErrorCode>(0x8612);  // CiA 402: reference limit

}  // namespace

void Cia402Drive::sync(std::uint8_t counter, std::uint64_t now_us) {
  last_period_us_ = now_us;
  take_input(counter);
  run_servo_period();
}

// Until a target comes: the axis holds its place, or goes to the target there was before.
void Cia402Drive::await_target() {
  target_arrived_ = settings_.behaviour.at_enabling == DriveBehaviour::AtEnabling::keeps_target;
  target_before_.reset();
  target_step_ = 0;
  targets_missed_ = 0;
}

// The target of this SYNC: a new one, or what the drive makes of a missing one.
void Cia402Drive::take_target() {
  using Missing = DriveBehaviour::MissingTarget;
  const DriveBehaviour& behaviour = settings_.behaviour;
  if (target_fresh_) {
    target_fresh_ = false;
    targets_missed_ = 0;
    target_taken_ = objects_.target;
    target_step_ =
        target_before_ ? wrapped(std::int64_t{target_taken_} - std::int64_t{*target_before_}) : 0;
    target_before_ = target_taken_;
    return;
  }
  const bool patient = targets_missed_ < behaviour.patience;
  if (targets_missed_ < UINT8_MAX) ++targets_missed_;
  if (behaviour.missing_target == Missing::extrapolated && patient)
    target_taken_ = wrapped(std::int64_t{target_taken_} + target_step_);
  const bool timer_ran_out =
      behaviour.target_timer != 0 && targets_missed_ >= behaviour.target_timer;
  if (timer_ran_out || (behaviour.missing_target == Missing::fault && !patient))
    fail(kTargetMissing);
}

void Cia402Drive::follow_at_once() {
  if (!target_fresh_ || !target_arrived_ || !in_cyclic_position()) return;
  target_taken_ = objects_.target;
  offset_taken_ = objects_.offset;
  demand_ = within_software_limits(wanted());
}

void Cia402Drive::take_input(std::uint8_t sync_counter) {
  const std::int32_t previous = offset_taken_;
  offset_taken_ = objects_.offset;
  // Right after enabling, the axis holds its place until the controller has sent a target for it.
  if (!in_cyclic_position() || !target_arrived_) return;
  take_target();
  if (in_cyclic_position()) demand_ = within_software_limits(wanted());
  if (on_input) on_input({target_taken_, offset_taken_, previous, sync_counter});
}

// 607Ah + 60B0h; of a rotary axis the turn that is nearest to the last demand.
std::int64_t Cia402Drive::wanted() const {
  const std::int64_t sum = std::int64_t{target_taken_} + offset_taken_;
  if (settings_.behaviour.range)
    return demand_ + settings_.behaviour.range->shortest(sum - demand_);
  return settings_.rotary ? demand_ + wrapped(sum - demand_) : sum;
}

// An axis that already stands outside may only come back.
std::int64_t Cia402Drive::within_software_limits(std::int64_t wanted) {
  limited_ = false;
  if (settings_.rotary) return wanted;
  const std::int64_t low = std::min<std::int64_t>(objects_.software_limit[0], demand_);
  const std::int64_t high = std::max<std::int64_t>(objects_.software_limit[1], demand_);
  const std::int64_t allowed = std::max(low, std::min(wanted, high));
  limited_ = allowed != wanted;
  if (limited_ && settings_.behaviour.beyond_limit == DriveBehaviour::BeyondLimit::fault)
    fail(kBeyondLimit);
  return allowed;
}

void Cia402Drive::run_servo_period() {
  move();
  ++periods_;
  for (Edge& edge : edges_)
    edge.latch_ns -= static_cast<std::int64_t>(1000U * period_us_);
  latch_edges();
  supervise();
  publish();
}

void Cia402Drive::move() {
  const host::PowerState state = machine_.state();
  if (in_cyclic_position()) {
    axis_.follow(demand_);
    return;
  }
  if (state == host::PowerState::quick_stop_active ||
      state == host::PowerState::fault_reaction_active)
    brake();
  else
    axis_.stand();
  demand_ = axis_.reading();
  limited_ = false;
}

void Cia402Drive::brake() {
  if (axis_.brake(objects_.quick_stop_deceleration)) machine_.standstill(stays_in_quick_stop());
}

void Cia402Drive::supervise() {
  const std::int64_t error = demand_ - axis_.reading();
  objects_.following_error = saturated(error);
  if (!in_cyclic_position()) large_error_us_ = 0;
  if (!in_cyclic_position() || objects_.following_window == host::kNoFollowingWindow) return;
  const bool large = std::abs(error) > std::int64_t{objects_.following_window};
  large_error_us_ = large ? large_error_us_ + period_us_ : 0;
  if (large && large_error_us_ > 1000U * std::uint64_t{settings_.following_timeout_ms})
    fail(host::kFollowingErrorCode);
}

void Cia402Drive::publish() {
  const std::int64_t idle = std::int64_t{settings_.offset_in_idle_demand} * objects_.offset;
  objects_.demand = on_wire(machine_.enabled() ? demand_ : demand_ + idle);
  objects_.actual = on_wire(axis_.reading());
  if (!home_offset_given_) objects_.home_offset = objects_.actual;
  objects_.statusword = statusword();
}

std::uint16_t Cia402Drive::statusword() const {
  unsigned word = host::status_pattern(machine_.state()) | host::kStatusVoltageEnabled |
                  host::kStatusRemote | mode_bits();
  if (referenced_) word |= host::kStatusReferenced;
  if (limited_) word |= host::kStatusInternalLimit;
  return static_cast<std::uint16_t>(word);
}

// Bits 10, 12 and 13. Homing by method 37 takes no time, so it is never under way.
std::uint16_t Cia402Drive::mode_bits() const {
  if (mode() == host::OperationMode::homing)
    return static_cast<std::uint16_t>(host::kStatusTargetReached |
                                      (homing_attained_ ? host::kStatusHomingAttained : 0));
  if (mode() != host::OperationMode::cyclic_position) return 0;
  const bool follows = machine_.enabled() && target_arrived_;
  const bool lags = fault_ == host::kFollowingErrorCode;
  return static_cast<std::uint16_t>((follows ? host::kStatusFollowsCommand : 0) |
                                    (lags ? host::kStatusFollowingError : 0));
}

}  // namespace volcomp::sim
