#pragma once
// How long a cycle takes in this node: from the last target that was received to the last offset
// (or forwarded target) that was handed to the port, and from SYNC to that last target. Compared
// with what the bus leaves it is the number by which a computer is judged (2620h, docs/drives.md).

#include <array>
#include <cstdint>

namespace volcomp::node {

class Latency {
 public:
  // Each a quarter of an octave: 4 µs, 4 × 2^(1/4) µs … 0.26 s. The first also has what is shorter.
  static constexpr std::size_t kBins = 64;
  using Histogram = std::array<std::uint32_t, kBins>;

  void clear() { *this = {}; }

  // SYNC: the cycle before is over. One without offsets does not count.
  void sync(std::uint64_t now_us) {
    if (sent_us_ != 0 && target_us_ != 0) note(since(sent_us_, target_us_));
    if (target_us_ != 0 && sync_us_ != 0)
      until_target_us_ = larger(until_target_us_, since(target_us_, sync_us_));
    sync_us_ = now_us;
    target_us_ = sent_us_ = 0;
  }
  void target(std::uint64_t now_us) { target_us_ = now_us; }
  void sent(std::uint64_t now_us) { sent_us_ = now_us; }

  [[nodiscard]] std::uint32_t cycles() const { return cycles_; }
  [[nodiscard]] std::uint32_t least_us() const { return least_us_; }
  [[nodiscard]] std::uint32_t largest_us() const { return largest_us_; }
  [[nodiscard]] std::uint32_t until_target_us() const { return until_target_us_; }
  [[nodiscard]] const Histogram& histogram() const { return bin_; }
  // The upper end of the bin that so many thousandths of the cycles do not exceed: to 19 %.
  [[nodiscard]] std::uint32_t quantile_us(std::uint32_t thousandths) const;

  [[nodiscard]] static std::size_t bin_of(std::uint32_t us);
  [[nodiscard]] static std::uint32_t end_of(std::size_t bin);

 private:
  static std::uint32_t larger(std::uint32_t a, std::uint32_t b) { return a < b ? b : a; }
  static std::uint32_t since(std::uint64_t later, std::uint64_t earlier) {
    const std::uint64_t us = later < earlier ? 0 : later - earlier;
    return us < UINT32_MAX ? static_cast<std::uint32_t>(us) : UINT32_MAX;
  }
  void note(std::uint32_t us);

  Histogram bin_{};
  std::uint64_t sync_us_ = 0;
  std::uint64_t target_us_ = 0;  // of the last one since SYNC, 0: none
  std::uint64_t sent_us_ = 0;
  std::uint32_t cycles_ = 0;
  std::uint32_t least_us_ = 0;
  std::uint32_t largest_us_ = 0;
  std::uint32_t until_target_us_ = 0;
};

}  // namespace volcomp::node
