#pragma once
// Which forwarded targets have been on the bus. Each that was handed to the port comes back when
// the driver has sent it (SocketCan::hear_own()); until then the next one of its axis waits, so
// that the queues of the kernel hold one target of an axis at most, and none that is older than a
// cycle.
//
// A port that gives nothing back proves nothing: that is told once, and nothing waits for it.

#include <array>
#include <cstdint>

#include "firmware/node/node_features.hpp"

namespace volcomp::posix {

class SendingProof {
 public:
  // Beyond this a frame is taken for lost: buffers of the driver are emptied at bus-off. Forwarding
  // has ended long before.
  static constexpr std::uint64_t kPatience_us = 250'000;

  // A frame with a target of this axis, in the order in which they are handed over.
  void handed_over(std::size_t axis, std::uint64_t now_us) {
    Axis& x = axis_[axis];
    if (x.under_way++ == 0) x.since_us = now_us;
  }
  void came_back(std::size_t axis, std::uint64_t now_us) {
    Axis& x = axis_[axis];
    proven_ = true;
    if (x.under_way != 0) --x.under_way;
    x.since_us = now_us;
  }
  // The port was closed or is off the bus: nothing comes back any more.
  void forget() { axis_ = {}; }

  // After all that has come back was told. True once: the port gives nothing back.
  [[nodiscard]] bool finds_no_proof(std::uint64_t now_us) {
    bool overdue = false;
    for (Axis& x : axis_) {
      if (x.under_way == 0 || now_us - x.since_us < kPatience_us) continue;
      overdue = true;
      x = {};
    }
    if (!overdue || proven_ || told_) return false;
    told_ = true;
    return true;
  }
  // Axes of which a target is under way, a bit each. None where nothing has ever come back.
  [[nodiscard]] std::uint32_t unconfirmed() const {
    std::uint32_t axes = 0;
    for (std::size_t a = 0; proven_ && a < axis_.size(); ++a)
      axes |= axis_[a].under_way != 0 ? 1U << a : 0U;
    return axes;
  }

 private:
  struct Axis {
    std::uint64_t since_us = 0;   // the oldest was handed over, or the one before it came back
    std::uint32_t under_way = 0;  // more than one only where nothing has come back yet
  };
  std::array<Axis, node::kNodeAxes> axis_{};
  bool proven_ = false;
  bool told_ = false;
};

}  // namespace volcomp::posix
