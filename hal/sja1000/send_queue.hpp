#pragma once
// Frames waiting for a CAN controller, in the order in which the bus would let them through: lowest
// identifier first, frames with the same identifier as they came. So a long SDO answer never holds
// up an offset. Fixed capacity; every call costs at most one pass over the waiting frames.

#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/can_port.hpp"

namespace volcomp::hal {

template <std::size_t Capacity>
class SendQueue {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  // Not while empty.
  [[nodiscard]] const CanFrame& front() const { return frames_[size_ - 1]; }

  // False when full.
  bool push(const CanFrame& frame) {
    if (size_ == Capacity) return false;
    insert_before_lower(frame, [&](const CanFrame& waiting) { return waiting.id <= frame.id; });
    return true;
  }

  // A frame taken before that could not leave: ahead of those with its identifier. There is always
  // a place for one.
  void put_back(const CanFrame& frame) {
    if (size_ > Capacity) return;
    insert_before_lower(frame, [&](const CanFrame& waiting) { return waiting.id < frame.id; });
  }

  // Not while empty.
  CanFrame pop() { return frames_[--size_]; }

  void clear() { size_ = 0; }

 private:
  // Keeps the most urgent frame last, where taking it moves no other.
  template <class GoesFirst>
  void insert_before_lower(const CanFrame& frame, GoesFirst goes_first) {
    const auto end = frames_.begin() + static_cast<std::ptrdiff_t>(size_);
    const auto place = std::find_if(frames_.begin(), end, goes_first);
    std::copy_backward(place, end, end + 1);
    *place = frame;
    ++size_;
  }

  std::array<CanFrame, Capacity + 1> frames_{};
  std::size_t size_ = 0;
};

}  // namespace volcomp::hal
