#pragma once
// Things handed from one context to another, for instance from an interrupt to the program it
// interrupts, without masking anything: one context only pushes, one only pops, neither ever waits.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/atomic_word.hpp"

namespace volcomp::hal {

template <class T, std::size_t Capacity>
class Ring {
  static_assert(Capacity > 0 && (Capacity & (Capacity - 1)) == 0,
                "a power of two, so that the counters may wrap around");

 public:
  // False when full; the new one is dropped.
  bool push(const T& element) {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == Capacity) return false;
    elements_[written % Capacity] = element;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  // False when empty.
  bool pop(T& element) {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (written_.load(std::memory_order_acquire) == read) return false;
    element = elements_[read % Capacity];
    read_.store(read + 1, std::memory_order_release);
    return true;
  }

  // For the context that pops.
  [[nodiscard]] bool empty() const {
    return written_.load(std::memory_order_acquire) == read_.load(std::memory_order_relaxed);
  }

  // For the context that pushes: so many will be taken at least.
  [[nodiscard]] std::size_t room() const {
    return Capacity -
           (written_.load(std::memory_order_relaxed) - read_.load(std::memory_order_acquire));
  }

 private:
  std::array<T, Capacity> elements_{};
  AtomicWord<> written_{0};
  AtomicWord<> read_{0};
};

}  // namespace volcomp::hal
