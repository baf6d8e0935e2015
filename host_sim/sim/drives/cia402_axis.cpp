#include "host_sim/sim/drives/cia402_axis.hpp"

#include <algorithm>
#include <utility>

namespace volcomp::sim {

void Cia402Axis::stand_at(std::int64_t units) {
  drive_.stand_at(units);
  stand();
}

void Cia402Axis::couple(ForeignMechanics mechanics) {
  foreign_ = std::move(mechanics);
  stand();
}

void Cia402Axis::advance(std::int64_t command) {
  const double before = position_units();
  drive_.command(command);
  previous_step_ = step_;
  step_ = position_units() - before;
}

void Cia402Axis::follow(std::int64_t demand) {
  braking_ = false;
  if (!foreign_.follow) return advance(demand - zero_shift_);
  drive_.stand_at(foreign_.read());
  foreign_.follow(demand - zero_shift_);
}

void Cia402Axis::stand() {
  braking_ = false;
  step_ = previous_step_ = 0.0;
  if (foreign_.read) drive_.stand_at(foreign_.read());
}

// The slower of the last two periods: a single jump of the command is not a speed.
double Cia402Axis::speed_before_braking() const {
  if (std::signbit(step_) != std::signbit(previous_step_)) return 0.0;
  return std::abs(step_) < std::abs(previous_step_) ? step_ : previous_step_;
}

bool Cia402Axis::brake(double units_per_s2) {
  if (!braking_) braking_step_ = speed_before_braking();
  braking_ = true;
  const double less = units_per_s2 * period_s_ * period_s_;
  braking_step_ = std::copysign(std::max(std::abs(braking_step_) - less, 0.0), braking_step_);
  if (std::abs(braking_step_) < 0.5) {
    stand();
    return true;
  }
  // The command that makes a first-order follower move by just this step.
  advance(std::llround(position_units() + braking_step_ / gain_));
  return false;
}

}  // namespace volcomp::sim
