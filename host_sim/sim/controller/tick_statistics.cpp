#include "host_sim/sim/controller/tick_statistics.hpp"

#include <algorithm>
#include <cstdlib>

namespace volcomp::sim {

void MachineTicks::cycle(const MachineSnapshot& now) {
  axes_ = now.axes;
  period_s_ = now.period_s;
  ++periods_;
  for (std::size_t a = 0; a < now.axes; ++a)
    count_axis(axis_[a], now.axis[a]);
  if (now.bus) count_bus(*now.bus);
  begun_ = true;
}

// A status lasts: its bits are counted when another one comes.
void MachineTicks::count_status(Axis& axis) {
  for (std::size_t bit = 0; bit < axis.ticks.periods.size(); ++bit)
    axis.ticks.periods[bit] += axis.same * ((axis.status >> bit) & 1U);
  axis.ticks.reported += axis.same;
  axis.same = 0;
}

void MachineTicks::count_axis(Axis& axis, const AxisSnapshot& now) {
  AxisTicks& ticks = axis.ticks;
  ticks.letter = now.letter;
  ticks.rotary = now.rotary;
  ticks.largest_offset = std::max(ticks.largest_offset, std::abs(now.offset));
  if (begun_)
    ticks.largest_change = std::max(ticks.largest_change, std::abs(now.offset - axis.offset));
  axis.offset = now.offset;
  latches_ += now.latches - axis.latches;
  axis.latches = now.latches;
  if (!now.correction_status) return;
  if (*now.correction_status != axis.status) count_status(axis);
  axis.status = *now.correction_status;
  ++axis.same;
}

// Counters of a node that was reset begin again.
void MachineTicks::count_bus(const BusState& now) {
  const auto grown = [](std::uint64_t to, std::uint64_t from) {
    return to < from ? to : to - from;
  };
  const BusState& before = last_bus_;
  bus_.ns += grown(now.now_ns, before.now_ns);
  bus_.busy_ns += grown(now.busy_ns, before.busy_ns);
  bus_.frames += grown(now.frames, before.frames);
  bus_.emergencies += grown(now.emergencies, before.emergencies);
  bus_.deadlines_missed +=
      grown(now.deadline_missed.value_or(0), before.deadline_missed.value_or(0));
  last_bus_ = now;
}

void TickStatistics::take(MachineTicks& machine) {
  if (machine.periods_ == 0) return;
  for (std::size_t a = 0; a < machine.axes_; ++a) {
    MachineTicks::count_status(machine.axis_[a]);
    AxisTicks& more = machine.axis_[a].ticks;
    AxisTicks& sum = axis(more);
    sum.largest_offset = std::max(sum.largest_offset, more.largest_offset);
    sum.largest_change = std::max(sum.largest_change, more.largest_change);
    sum.reported += more.reported;
    for (std::size_t bit = 0; bit < sum.periods.size(); ++bit)
      sum.periods[bit] += more.periods[bit];
    more = {};
  }
  periods_[machine.period_s_] += machine.periods_;
  bus_.ns += machine.bus_.ns;
  bus_.busy_ns += machine.bus_.busy_ns;
  bus_.frames += machine.bus_.frames;
  bus_.deadlines_missed += machine.bus_.deadlines_missed;
  bus_.emergencies += machine.bus_.emergencies;
  latches_ += machine.latches_;
  machine.periods_ = machine.latches_ = 0;
  machine.bus_ = {};
}

std::uint64_t TickStatistics::periods() const {
  std::uint64_t sum = 0;
  for (const auto& [length_s, count] : periods_)
    sum += count;
  return sum;
}

double TickStatistics::machine_time_s() const {
  double sum = 0.0;
  for (const auto& [length_s, count] : periods_)
    sum += static_cast<double>(count) * length_s;
  return sum;
}

AxisTicks& TickStatistics::axis(const AxisTicks& like) {
  const auto same = [&like](const AxisTicks& t) { return t.letter == like.letter; };
  const auto found = std::find_if(axes_.begin(), axes_.end(), same);
  if (found != axes_.end()) return *found;
  AxisTicks ticks;
  ticks.letter = like.letter;
  ticks.rotary = like.rotary;
  return axes_.emplace_back(ticks);
}

double TickStatistics::bus_load() const {
  return bus_.ns == 0 ? 0.0 : static_cast<double>(bus_.busy_ns) / static_cast<double>(bus_.ns);
}

}  // namespace volcomp::sim
