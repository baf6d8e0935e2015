#pragma once
// What the motion controller does for one CiA 402 axis, cycle by cycle: brings the drive to
// operation enabled, references it, then lets it follow the path in cyclic synchronous position
// mode.

#include <algorithm>
#include <cstdint>

namespace volcomp::sim {

// CiA 402 modes of operation (6060h).
inline constexpr std::int8_t kHomingMode = 6;
inline constexpr std::int8_t kCyclicPosition = 8;

class AxisCommander {
 public:
  // --- reports of the drive
  void actual(std::int32_t position, std::uint16_t status_word) {
    at_rest_ = position == actual_ ? static_cast<std::uint16_t>(std::min(at_rest_ + 1, 1000)) : 0;
    actual_ = position;
    status_ = status_word;
    heard_ = true;
  }
  void held(std::int32_t offset) { held_ = offset; }
  void mode_is(std::int8_t mode) { mode_ = mode; }
  void drive_lost();
  // The drive may be enabled: whoever sends it its targets is there.
  void may_enable(bool may) { may_enable_ = may; }
  // All axes of the machine stop.
  void stop_quickly() { stops_ = true; }

  // --- once per cycle, with the drive in OPERATIONAL; `path` is where it should go
  void step(std::int32_t path);

  [[nodiscard]] std::uint16_t control_word() const { return control_; }
  [[nodiscard]] std::int32_t target() const { return target_; }
  // The mode the drive should be put into, 0 when it is in the right one.
  [[nodiscard]] std::int8_t wanted_mode() const { return wanted_mode_; }
  // Follows the path; otherwise target() stays where the axis is.
  [[nodiscard]] bool following() const { return following_; }
  // Where a path may start: the position without the offset.
  [[nodiscard]] std::int32_t standing_at() const;
  [[nodiscard]] std::uint16_t status_word() const { return status_; }

 private:
  std::int32_t actual_ = 0;
  std::int32_t held_ = 0;
  std::int32_t target_ = 0;
  std::uint16_t status_ = 0;
  std::uint16_t control_ = 0;
  std::uint16_t waited_ = 0;
  std::uint16_t at_rest_ = 0;  // cycles
  std::int8_t mode_ = 0;
  std::int8_t wanted_mode_ = 0;
  bool may_enable_ = true;
  bool stops_ = false;  // in this cycle
  bool heard_ = false;
  bool following_ = false;
};

}  // namespace volcomp::sim
