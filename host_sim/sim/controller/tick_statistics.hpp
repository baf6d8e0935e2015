#pragma once
// What the compensation did in all control periods of a run, counted while they went by.

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

class TickStatistics final : public MachineWatch {
 public:
  [[nodiscard]] std::uint32_t enter() override;
  void cycle(const MachineSnapshot& now) override;

  [[nodiscard]] std::size_t machines() const { return last_.size(); }
  [[nodiscard]] std::uint64_t periods() const { return periods_; }
  [[nodiscard]] double machine_time_s() const { return machine_time_s_; }
  [[nodiscard]] const std::vector<AxisTicks>& axes() const { return axes_; }

  // Figures of the bus; 0 where there was none.
  [[nodiscard]] bool on_a_bus() const { return bus_ns_ > 0; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] double bus_load() const;  // share of the time it was busy, without stuff bits
  [[nodiscard]] std::uint64_t deadlines_missed() const { return deadlines_missed_; }
  [[nodiscard]] std::uint64_t emergencies() const { return emergencies_; }
  [[nodiscard]] std::uint64_t latches() const { return latches_; }

 private:
  AxisTicks& axis(const AxisSnapshot& snapshot);
  void count_axis(const AxisSnapshot& now, const AxisSnapshot* before);
  void count_bus(const BusState& now, const BusState& before);

  std::vector<MachineSnapshot> last_;  // by machine
  std::vector<AxisTicks> axes_;        // in the order they were met
  std::uint64_t periods_ = 0;
  double machine_time_s_ = 0.0;
  std::uint64_t bus_ns_ = 0;
  std::uint64_t busy_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t deadlines_missed_ = 0;
  std::uint64_t emergencies_ = 0;
  std::uint64_t latches_ = 0;
};

}  // namespace volcomp::sim
