#pragma once
// The block device of hal/block_device.hpp in memory, for tests: behaves like NOR flash and can
// lose power at any byte.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "comp/span.hpp"

namespace volcomp::hal {

template <std::size_t SectorBytes, std::size_t Sectors>
class MemoryBlocks {
 public:
  static constexpr std::size_t kSectorBytes = SectorBytes;
  static constexpr std::size_t kSectors = Sectors;
  static constexpr std::size_t kBytes = SectorBytes * Sectors;

  MemoryBlocks() { bytes_.fill(0xFF); }

  // Power fails at step n from now, counted from 0; a step is one byte written or one sector
  // erased. The byte of that step is not written, of the sector only the first half is erased, and
  // everything returns false until power_on().
  void fail_after(std::size_t n) { steps_left_ = n; }
  void power_on() {
    powered_ = true;
    steps_left_ = kNever;
  }
  [[nodiscard]] bool powered() const { return powered_; }

  // Steps completed since the beginning: how many moments there are to fail at.
  [[nodiscard]] std::size_t steps() const { return steps_; }

  // Calls refused because they were outside the device or would have set a cleared bit: mistakes of
  // the store above.
  [[nodiscard]] std::size_t misuses() const { return misuses_; }

  bool read(std::size_t at, Span<std::uint8_t> out) {
    if (!powered_ || !inside(at, out.size())) return false;
    std::copy_n(bytes_.data() + at, out.size(), out.data());
    return true;
  }

  // A write that would set a cleared bit changes nothing.
  bool write(std::size_t at, Span<const std::uint8_t> bytes) {
    if (!powered_ || !inside(at, bytes.size()) || !only_clears_bits(at, bytes)) return false;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (!step()) return false;
      bytes_[at + i] = bytes[i];
    }
    return true;
  }

  bool erase(std::size_t sector) {
    if (!powered_ || !count_misuse_unless(sector < Sectors)) return false;
    const bool whole = step();
    std::fill_n(bytes_.data() + sector * SectorBytes, whole ? SectorBytes : SectorBytes / 2,
                std::uint8_t{0xFF});
    return whole;
  }

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  bool count_misuse_unless(bool right) {
    misuses_ += right ? 0U : 1U;
    return right;
  }
  bool inside(std::size_t at, std::size_t size) {
    return count_misuse_unless(at <= kBytes && size <= kBytes - at);
  }
  bool only_clears_bits(std::size_t at, Span<const std::uint8_t> bytes) {
    return count_misuse_unless(std::equal(
        bytes.begin(), bytes.end(), bytes_.data() + at,
        [](std::uint8_t wanted, std::uint8_t present) { return (wanted & present) == wanted; }));
  }

  bool step() {
    if (steps_left_ == 0) {
      powered_ = false;
      return false;
    }
    if (steps_left_ != kNever) --steps_left_;
    ++steps_;
    return true;
  }

  std::array<std::uint8_t, kBytes> bytes_;
  std::size_t steps_left_ = kNever;
  std::size_t steps_ = 0;
  std::size_t misuses_ = 0;
  bool powered_ = true;
};

}  // namespace volcomp::hal
