#pragma once
// The last station before a drive: which offset may be sent, so that the drive never sees a step
// above the slew limit, whatever is lost, late or restarted.
//
// A drive takes the newest offset it has when SYNC comes. A frame that was lost leaves the old one
// in force, a frame that was held up may arrive after a newer one. So the drive may take any value
// sent in the last few cycles, and it may still hold what it last reported. The gate keeps all
// those values within one slew limit of each other. It therefore needs the drive to report the
// offset it has taken (60B0h mapped into a TPDO), and:
//   - is silent until the drive has reported one and the same value for as long as an offset and
//     the report of it can be under way (start of the node, restart of the drive);
//   - repeats its last value while a report is missing, and falls silent when it stays missing;
//   - starts again from the drive's value when that is none of its own.

#include <array>
#include <cstdint>

namespace volcomp::node {

class OffsetGate {
 public:
  static constexpr std::uint8_t kMostLate = 7;

  // `slew`: largest step, wire units, ≥ 1. `late`: cycles a frame may be late, 0…kMostLate.
  // Without reports the gate trusts that what it sent has arrived.
  void configure(std::int32_t slew, std::uint8_t late, bool reports);

  // Knows nothing any more: silent until the drive has reported. For a drive that was restarted,
  // unless it stays away for silence_after_restart() cycles and the gate finds out by itself.
  void forget();
  // The drive holds this offset and nothing is under way (read from the drive at start-up).
  void start_at(std::int32_t held);
  // The drive's report of this cycle.
  void report(std::int32_t held);

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] std::int32_t slew() const { return slew_; }
  [[nodiscard]] std::int32_t last() const { return last_; }
  // Cycles in a row without a report, saturating.
  [[nodiscard]] std::uint8_t unreported() const { return unreported_; }

  // Once per cycle, after the reports: a drive that has reported long enough opens the gate.
  void begin_cycle();
  // Then once: the value to send. False: nothing may be sent.
  bool next(std::int32_t wanted, std::int32_t& value);

  // The slew per cycle at which the gate never limits.
  [[nodiscard]] static std::int32_t unhindered(std::int32_t slew, std::uint8_t late) {
    const std::int32_t rate = slew / (2 * late + 3);
    return rate < 1 ? 1 : rate;
  }
  // Cycles without reports after which nothing sent before them is under way any more.
  [[nodiscard]] static constexpr int silence_after_restart(std::uint8_t late) {
    return 3 * late + 4;
  }

 private:
  // Reports may be late as well as offsets, hence twice.
  static constexpr std::size_t kMemory = 2 * kMostLate + 2;

  [[nodiscard]] bool sent_recently(std::int32_t value) const;
  [[nodiscard]] std::int32_t limited(std::int32_t wanted) const;
  void remember(std::int32_t value);

  std::array<std::int32_t, kMemory> sent_{};
  std::int32_t slew_ = 1;
  std::int32_t held_ = 0;  // last report
  std::int32_t last_ = 0;  // last value sent
  std::uint8_t late_ = 2;
  std::uint8_t at_ = 0;    // oldest entry of sent_
  std::uint8_t same_ = 0;  // equal reports in a row while silent
  std::uint8_t unreported_ = 0;
  bool reports_ = true;
  bool open_ = false;
  bool reported_ = false;  // since the last begin_cycle()
  bool fresh_ = false;     // held_ belongs to this cycle
};

}  // namespace volcomp::node
