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
// by is held twice and compared before every value. When the copies differ, the gate moves to 0 and
// stays there.
//
// Where offsets are limited in acceleration, it checks by itself that what it is given keeps limit,
// rate and acceleration: three differences, no law of braking. The first value that does not is the
// last one it looks at: from the last good offset and step it moves to 0 within the same bounds and
// stays there. A missing report then brakes instead of repeating the last value, as far as the
// values that can be under way allow: they stay within one slew of each other even where a step
// then changes by more than the acceleration. After that, or from a value that the drive held, a
// limiter leads back to what is wanted.
//
// Bounds are set at the start alone: while the node is OPERATIONAL their objects are fixed, so no
// offset is ever on its way from old bounds to new ones.
//
// It records the values handed to the port, not those it has computed: only the former can reach a
// drive.

#include <array>
#include <cstdint>

#include "comp/tick/offset_limiter.hpp"
#include "firmware/node/wire_scale.hpp"

namespace volcomp::node {

// No drive holds an offset as large, in wire units; the sum of two fits into 32 bits.
inline constexpr std::int32_t kMostHeld = (1 << 30) - 1;

// Wire units. Larger numbers than kMostHeld mean kMostHeld.
struct GateBounds {
  std::int32_t limit = kMostHeld;  // largest |offset|, ≥ 0
  std::int32_t slew = 1;           // largest step, ≥ 1
  std::int32_t soft = kMostHeld;   // the same on the way from what a drive holds, ≥ 1
  // Of what the gate is given: largest step, ≥ 1, and largest change of the step; 0: unchecked.
  std::int32_t rate = kMostHeld;
  std::int32_t acceleration = 0;
  WireScale scale{};      // of what the gate is given; it only keeps it
  std::uint8_t late = 2;  // cycles a frame may be late, 0…OffsetGate::kMostLate
  // 0: there are no reports, the gate assumes that every value handed over arrives. Not a bool: a
  // flipped bit would make it neither true nor false.
  std::uint8_t reports = 1;
};

class OffsetGate {
 public:
  static constexpr std::uint8_t kMostLate = 7;

  OffsetGate() { configure({}); }
  // Also ends the move to 0 after damage or a refused value.
  void configure(const GateBounds& bounds);

  // Discards its state: sends nothing until the drive has reported. For a drive that was restarted,
  // unless it stays away for silence_after_restart() cycles and the gate detects it.
  void forget();
  // The drive holds this offset and nothing is under way (read from the drive at start-up). Beyond
  // ±kMostHeld the gate sends nothing.
  void start_at(std::int32_t held);
  // The wanted value starts at that of the gate: there is no approach.
  void join() {
    approaching_ = apart_ = false;
    expect(last_);
  }
  // The wanted value starts at this one, at rest.
  void expect(std::int32_t wanted) {
    given_ = wanted;
    given_step_ = 0;
    known_ = 2;
  }
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
  // A wanted value was beyond limit, rate or acceleration: it moves to 0 or is there.
  [[nodiscard]] bool refused() const { return refused_; }
  // One of both.
  [[nodiscard]] bool goes_home() const { return tripped_ || refused_; }
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
  // Reports may be late as well as offsets, hence twice; and while they are missing, values go on.
  static constexpr std::size_t kMemory = 3 * kMostLate + 3;

  // Values that can be under way; never more than there is room for, whatever `late` has become.
  [[nodiscard]] std::size_t window() const {
    const std::size_t missing = bounds_.acceleration != 0 ? unreported_ : 0U;
    const std::size_t values = 2U * bounds_.late + 2U + missing;
    return values < kMemory ? values : kMemory;
  }
  // Whether is(value) is true of a value that can be under way, the newest first.
  template <class Is>
  bool any_sent(const Is& is) const {
    std::size_t at = at_ % kMemory;
    for (std::size_t left = window(); left != 0; --left) {
      if (is(sent_[at])) return true;
      at = at != 0 ? at - 1U : kMemory - 1U;
    }
    return false;
  }
  [[nodiscard]] bool sent_recently(std::int32_t value) const;
  [[nodiscard]] std::int32_t furthest() const;
  [[nodiscard]] std::int32_t within_window(std::int32_t value) const;
  [[nodiscard]] std::int32_t limited(std::int32_t wanted) const;
  [[nodiscard]] bool accept(std::int32_t wanted);
  [[nodiscard]] std::int32_t moved(std::int32_t wanted, std::int32_t before);
  void trip();

  std::array<std::int32_t, kMemory> sent_{};
  GateBounds bounds_{};
  GateBounds copy_{};
  std::uint32_t sum_ = 0;        // of the words of the bounds: which copy is right
  OffsetLimiter<true> way_{};    // while apart: from what the drive holds to what is wanted
  std::int32_t given_ = 0;       // wanted last
  std::int32_t given_step_ = 0;  // its change
  std::int32_t step_ = 0;        // change by the value handed over last
  std::int32_t held_ = 0;        // last report
  std::int32_t last_ = 0;        // handed over last
  std::uint8_t at_ = 0;          // newest entry of sent_
  std::uint8_t same_ = 0;        // equal reports in a row while nothing is sent
  std::uint8_t unreported_ = 0;
  bool tripped_ = false;
  bool refused_ = false;
  std::uint8_t known_ = 0;  // 1: given_, 2: given_step_, too
  bool apart_ = false;      // not where what is wanted is
  bool met_ = false;        // the value handed over last was the one wanted
  bool handed_ = false;     // since the last begin_cycle()
  bool open_ = false;
  bool approaching_ = false;  // moves to the wanted value at the soft rate
  bool meets_ = false;        // the value of next() is the one wanted
  bool reported_ = false;     // since the last begin_cycle()
  bool fresh_ = false;        // held_ belongs to this cycle
};

}  // namespace volcomp::node
