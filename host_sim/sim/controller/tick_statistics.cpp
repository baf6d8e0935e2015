#include "host_sim/sim/controller/tick_statistics.hpp"

#include <algorithm>
#include <cstdlib>

namespace volcomp::sim {

std::uint32_t TickStatistics::enter() {
  last_.emplace_back();
  return static_cast<std::uint32_t>(last_.size() - 1);
}

void TickStatistics::cycle(const MachineSnapshot& now) {
  MachineSnapshot& before = last_.at(now.machine);
  ++periods_;
  machine_time_s_ += now.period_s;
  for (std::size_t a = 0; a < now.axes; ++a)
    count_axis(now.axis[a], before.cycle > 0 ? &before.axis[a] : nullptr);
  if (now.bus) count_bus(*now.bus, before.bus.value_or(BusState{}));
  before = now;
}

AxisTicks& TickStatistics::axis(const AxisSnapshot& snapshot) {
  const auto same = [&snapshot](const AxisTicks& t) { return t.letter == snapshot.letter; };
  const auto found = std::find_if(axes_.begin(), axes_.end(), same);
  if (found != axes_.end()) return *found;
  AxisTicks ticks;
  ticks.letter = snapshot.letter;
  ticks.rotary = snapshot.rotary;
  return axes_.emplace_back(ticks);
}

void TickStatistics::count_axis(const AxisSnapshot& now, const AxisSnapshot* before) {
  AxisTicks& ticks = axis(now);
  ticks.largest_offset = std::max(ticks.largest_offset, std::abs(now.offset));
  if (before != nullptr)
    ticks.largest_change = std::max(ticks.largest_change, std::abs(now.offset - before->offset));
  latches_ += now.latches - (before != nullptr ? before->latches : 0);
  if (!now.correction_status) return;
  ++ticks.reported;
  for (std::size_t bit = 0; bit < ticks.periods.size(); ++bit)
    ticks.periods[bit] += (*now.correction_status >> bit) & 1U;
}

// Counters of a node that was reset begin again.
void TickStatistics::count_bus(const BusState& now, const BusState& before) {
  const auto grown = [](std::uint64_t to, std::uint64_t from) {
    return to < from ? to : to - from;
  };
  bus_ns_ += grown(now.now_ns, before.now_ns);
  busy_ns_ += grown(now.busy_ns, before.busy_ns);
  frames_ += grown(now.frames, before.frames);
  emergencies_ += grown(now.emergencies, before.emergencies);
  deadlines_missed_ += grown(now.deadline_missed.value_or(0), before.deadline_missed.value_or(0));
}

double TickStatistics::bus_load() const {
  return bus_ns_ == 0 ? 0.0 : static_cast<double>(busy_ns_) / static_cast<double>(bus_ns_);
}

}  // namespace volcomp::sim
