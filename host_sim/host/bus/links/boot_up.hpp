#pragma once
// A node behind a link that has just been started.

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

// Waits for the boot-up message of a node and drops it, so that a reset that follows has one of its
// own. False when there is none in `most` waits of a millisecond.
[[nodiscard]] inline bool await_boot_up(FrameLink& link, int most = 10'000) {
  const auto boot_up = [](const hal::CanFrame& frame) {
    return (frame.id & ~unsigned{canopen::kMaxNodeId}) == canopen::kHeartbeat && frame.size == 1 &&
           frame.data[0] == 0;
  };
  hal::CanFrame frame;
  for (int i = 0; i < most; ++i) {
    link.wait(1000);
    while (link.receive(frame)) {
      if (boot_up(frame)) return true;
    }
  }
  return false;
}

}  // namespace volcomp::host
