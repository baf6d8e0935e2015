#pragma once
// What the compensation did in all control periods of a run, counted while they went by. Each
// machine counts for itself, without a lock; the sums do not depend on which machine is added
// first.

#include <map>
#include <vector>

#include "comp/tick/tick_types.hpp"
#include "host_sim/sim/controller/machine_watch.hpp"

namespace volcomp::sim {

// Run-time units: nm or 2^-40 turn.
struct AxisTicks {
  char letter = '\0';
  bool rotary = false;
  std::int64_t largest_offset = 0;                   // magnitude
  std::int64_t largest_change = 0;                   // of the offset, from one period to the next
  std::uint64_t reported = 0;                        // periods in which the status was known
  std::array<std::uint64_t, kStatusBits> periods{};  // in which a bit of it was set
};

struct BusTicks {
  std::uint64_t ns = 0;
  std::uint64_t busy_ns = 0;
  std::uint64_t frames = 0;
  std::uint64_t deadlines_missed = 0;
  std::uint64_t emergencies = 0;
};

// The counts of one machine since they were taken last.
class MachineTicks {
 public:
  void cycle(const MachineSnapshot& now);
  // Edges that its touch probe has latched, all axes.
  [[nodiscard]] std::uint64_t latches() const { return latches_; }

 private:
  friend class TickStatistics;

  struct Axis {
    AxisTicks ticks;
    std::int64_t offset = 0;    // of the last period
    std::uint64_t latches = 0;  // so far
    std::uint16_t status = 0;   // of the last periods, as many as
    std::uint64_t same = 0;     // these, which ticks.periods does not yet hold
  };

  static void count_status(Axis& axis);
  void count_axis(Axis& axis, const AxisSnapshot& now);
  void count_bus(const BusState& now);

  std::array<Axis, host::kMostAxes> axis_{};
  std::size_t axes_ = 0;
  bool begun_ = false;
  double period_s_ = 0.0;
  std::uint64_t periods_ = 0;
  std::uint64_t latches_ = 0;
  BusTicks bus_;
  BusState last_bus_;
};

class TickStatistics {
 public:
  void enter() { ++machines_; }
  // Adds the counts of a machine, which begin again.
  void take(MachineTicks& machine);

  [[nodiscard]] std::size_t machines() const { return machines_; }
  [[nodiscard]] std::uint64_t periods() const;
  [[nodiscard]] double machine_time_s() const;
  [[nodiscard]] const std::vector<AxisTicks>& axes() const { return axes_; }

  // Figures of the bus; 0 where there was none.
  [[nodiscard]] bool on_a_bus() const { return bus_.ns > 0; }
  [[nodiscard]] std::uint64_t frames() const { return bus_.frames; }
  [[nodiscard]] double bus_load() const;  // share of the time it was busy, without stuff bits
  [[nodiscard]] std::uint64_t deadlines_missed() const { return bus_.deadlines_missed; }
  [[nodiscard]] std::uint64_t emergencies() const { return bus_.emergencies; }
  [[nodiscard]] std::uint64_t latches() const { return latches_; }

 private:
  AxisTicks& axis(const AxisTicks& like);

  std::size_t machines_ = 0;
  std::vector<AxisTicks> axes_;              // in the order they were met
  std::map<double, std::uint64_t> periods_;  // by their length, s
  BusTicks bus_;
  std::uint64_t latches_ = 0;
};

}  // namespace volcomp::sim
