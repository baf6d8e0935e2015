#pragma once
// Joins the simulated bus to nodes elsewhere: what devices in this process send goes out over a
// link, what comes in they receive.

#include "hal/loopback/loopback_bus.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::sim {

class CanGateway {
 public:
  // `link` must outlive the gateway. Every function throws UserError when it is of no use any more.
  explicit CanGateway(host::FrameLink& link) : link_(link) {}

  // Both ways, everything there is: the caller decides when, so that what belongs to one cycle goes
  // out in one burst.
  void exchange(hal::LoopbackBus::Port& port);
  // Returns when a frame may have arrived or the time has passed.
  void wait(std::uint32_t timeout_us) { link_.wait(timeout_us); }
  // Time of the nodes behind the link.
  [[nodiscard]] std::uint64_t now_us() const { return link_.now_us(); }

 private:
  host::FrameLink& link_;
};

}  // namespace volcomp::sim
