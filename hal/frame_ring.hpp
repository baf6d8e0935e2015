#pragma once
// Frames handed from one context to another, for instance from an interrupt to the program it
// interrupts, without masking anything: one context only pushes, one only pops, neither ever waits.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "hal/can_port.hpp"

namespace volcomp::hal {

template <std::size_t Capacity>
class FrameRing {
  static_assert(Capacity > 0 && (Capacity & (Capacity - 1)) == 0,
                "a power of two, so that the counters may wrap around");

 public:
  // False when full; the frame is dropped.
  bool push(const CanFrame& frame) {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == Capacity) return false;
    frames_[written % Capacity] = frame;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  // False when empty.
  bool pop(CanFrame& frame) {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (written_.load(std::memory_order_acquire) == read) return false;
    frame = frames_[read % Capacity];
    read_.store(read + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<CanFrame, Capacity> frames_{};
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> read_{0};
};

}  // namespace volcomp::hal
