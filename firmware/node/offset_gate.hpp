#pragma once
// The last station before a drive: which offset may be sent, so that the drive never sees a step
// above the slew limit, whatever is lost, late or restarted.
//
// A drive takes the newest offset it has when SYNC comes. A frame that was lost leaves the old one
// in force, a frame that was held up may arrive after a newer one. So the drive may take any value
// sent in the last few cycles, and it may still hold what it last reported. The gate keeps all
// those values within one slew limit of each other. It therefore needs the drive to report the
// offset it has taken (60B0h mapped into a TPDO), and:
//   - sends nothing until the drive has reported one and the same value for as long as an offset
//     and the report of it can be under way (start of the node, restart of the drive);
//   - repeats its last value while a report is missing, and stops sending when it stays missing;
//   - starts again from the drive's value when that is none of its own, and then moves to the
//     wanted value at the soft rate.
//
// It has a limit of its own, so that no fault before it moves a drive further. What it is bounded
// by is held twice and compared before every value. When the copies differ, the configured value is
// unknown: the gate then moves to 0 and stays there.
//
// It records the values handed to the port, not those it has computed: only the former can reach a
// drive.

#include <array>
#include <cstdint>

#include "firmware/node/wire_scale.hpp"

namespace volcomp::node {

// No drive holds an offset as large, in wire units; the sum of two fits into 32 bits.
inline constexpr std::int32_t kMostHeld = (1 << 30) - 1;

// Wire units. Larger numbers than kMostHeld mean kMostHeld.
struct GateBounds {
  std::int32_t limit = kMostHeld;  // largest |offset|, ≥ 0
  std::int32_t slew = 1;           // largest step, ≥ 1
  std::int32_t soft = kMostHeld;   // the same on the way from what a drive holds, ≥ 1
  WireScale scale{};               // of what the gate is given; it only keeps it
  std::uint8_t late = 2;           // cycles a frame may be late, 0…OffsetGate::kMostLate
  // 0: there are no reports, the gate assumes that every value handed over arrives. Not a bool: a
  // flipped bit would make it neither true nor false.
  std::uint8_t reports = 1;
};

class OffsetGate {
 public:
  static constexpr std::uint8_t kMostLate = 7;

  OffsetGate() { configure({}); }
  // Also ends the move to 0 after damage.
  void configure(const GateBounds& bounds);

  // Discards its state: sends nothing until the drive has reported. For a drive that was restarted,
  // unless it stays away for silence_after_restart() cycles and the gate detects it.
  void forget();
  // The drive holds this offset and nothing is under way (read from the drive at start-up). Beyond
  // ±kMostHeld the gate sends nothing.
  void start_at(std::int32_t held);
  // The wanted value starts at that of the gate: there is no approach.
  void join() { approaching_ = false; }
  // The drive's report of this cycle. Nothing happens where the gate counts on none.
  void report(std::int32_t held);

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] std::int32_t slew() const { return bounds_.slew; }
  [[nodiscard]] const WireScale& scale() const { return bounds_.scale; }
  // The value handed over last.
  [[nodiscard]] std::int32_t last() const { return last_; }
  // Whether its bounds are as configured.
  [[nodiscard]] bool intact() const;
  // The same for gates that send no values: false from the damage on.
  bool check() {
    if (!intact()) trip();
    return !tripped_;
  }
  // They were not: it moves to 0 or is there.
  [[nodiscard]] bool tripped() const { return tripped_; }
  // Cycles in a row without a report, saturating.
  [[nodiscard]] std::uint8_t unreported() const { return unreported_; }

  // Once per cycle, after the reports: a drive that has reported long enough opens the gate.
  void begin_cycle();
  // Then once: the value to send. False: nothing may be sent.
  bool next(std::int32_t wanted, std::int32_t& value);
  // This value of next() has been handed to the port. A value that is not handed over before the
  // next cycle is replaced and does not count.
  void handed_over(std::int32_t value);

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

  // Values that can be under way; never more than there is room for, whatever `late` has become.
  [[nodiscard]] std::size_t window() const {
    const std::size_t values = 2U * bounds_.late + 2U;
    return values < kMemory ? values : kMemory;
  }
  [[nodiscard]] bool sent_recently(std::int32_t value) const;
  [[nodiscard]] std::int32_t limited(std::int32_t wanted) const;
  void trip();

  std::array<std::int32_t, kMemory> sent_{};
  GateBounds bounds_{};
  GateBounds copy_{};
  std::int32_t held_ = 0;  // last report
  std::int32_t last_ = 0;  // handed over last
  std::uint8_t at_ = 0;    // newest entry of sent_
  std::uint8_t same_ = 0;  // equal reports in a row while nothing is sent
  std::uint8_t unreported_ = 0;
  bool tripped_ = false;
  bool open_ = false;
  bool approaching_ = false;  // moves to the wanted value at the soft rate
  bool meets_ = false;        // the value of next() is the one wanted
  bool reported_ = false;     // since the last begin_cycle()
  bool fresh_ = false;        // held_ belongs to this cycle
};

}  // namespace volcomp::node
