#pragma once
// A first-in, first-out queue of CAN frames with a fixed capacity, allocated once.

#include <cstddef>
#include <vector>

#include "hal/can_port.hpp"

namespace volcomp::hal {

class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) : frames_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const CanFrame& front() const { return frames_[first_]; }

  // False when full.
  bool push(const CanFrame& frame) {
    if (size_ == frames_.size()) return false;
    const std::size_t at = first_ + size_;
    frames_[at < frames_.size() ? at : at - frames_.size()] = frame;
    ++size_;
    return true;
  }

  // False when empty.
  bool pop(CanFrame& frame) {
    if (empty()) return false;
    frame = frames_[first_];
    first_ = first_ + 1 < frames_.size() ? first_ + 1 : 0;
    --size_;
    return true;
  }

  void clear() { size_ = 0; }

 private:
  std::vector<CanFrame> frames_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace volcomp::hal
