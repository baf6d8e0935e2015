#pragma once
// Lets the kernel throw away the frames that do nothing in the node, so that they do not wake it.

#include <algorithm>

#include "firmware/canopen/device_base.hpp"
#include "hal/linux/lasting_can.hpp"

namespace volcomp::posix {

class KernelFilter {
 public:
  // After every turn: what is heard changes with 1005h, 1016h and the PDOs.
  void follow(const canopen::DeviceBase& device, hal::LastingCan& port) {
    canopen::DeviceBase::HeardIds ids{};
    const std::size_t count = device.heard(ids);
    if (count == count_ && std::equal(ids.begin(), ids.begin() + count, ids_.begin())) return;
    ids_ = ids;
    count_ = count;
    // Where the kernel refuses, all frames come, and the node takes what is its own.
    static_cast<void>(port.hear_only({ids_.data(), count_}));
  }

 private:
  canopen::DeviceBase::HeardIds ids_{};
  std::size_t count_ = 0;
};

}  // namespace volcomp::posix
