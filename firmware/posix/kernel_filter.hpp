#pragma once
// Lets the kernel throw away the frames that do nothing in the node, so that they do not wake it.

#include <algorithm>

#include "firmware/node/node.hpp"
#include "hal/linux/lasting_can.hpp"

namespace volcomp::posix {

class KernelFilter {
 public:
  // After every turn: what is heard changes with 1005h, 1016h and the PDOs. Forwarded targets are
  // heard, too: they come back when they have been on the bus.
  void follow(const node::Node& node, hal::LastingCan& port) {
    Ids ids{};
    std::size_t count = 0;
    canopen::DeviceBase::HeardIds heard{};
    for (const std::size_t all = node.device().heard(heard); count < all; ++count)
      ids[count] = heard[count];
    for (std::size_t a = 0; a < node::kNodeAxes; ++a) {
      const canopen::Pdo& target = node.device().pdos().transmit()[a];
      if ((node.forwarded_axes() >> a & 1U) != 0 && target.valid()) ids[count++] = target.id();
    }
    if (count == count_ && std::equal(ids.begin(), ids.begin() + count, ids_.begin())) return;
    ids_ = ids;
    count_ = count;
    // Where the kernel refuses, all frames come, and the node takes what is its own.
    static_cast<void>(port.hear_only({ids_.data(), count_}));
  }

 private:
  using Ids = std::array<std::uint16_t, canopen::DeviceBase::kMostHeard + node::kNodeAxes>;
  static_assert(Ids{}.size() <= hal::SocketCan::kMostFilters);

  Ids ids_{};
  std::size_t count_ = 0;
};

}  // namespace volcomp::posix
