#pragma once
// Joins the simulated bus to a real one: what devices in this process send goes out, what comes in
// they receive.

#include <string>

#include "hal/linux/socket_can.hpp"
#include "hal/loopback/loopback_bus.hpp"

namespace volcomp::sim {

class CanGateway {
 public:
  // Throws UserError naming the interface.
  explicit CanGateway(const std::string& interface);

  // Both ways, everything there is: the caller decides when, so that what belongs to one cycle goes
  // out in one burst.
  void exchange(hal::LoopbackBus::Port& port);
  // Returns when a frame has arrived or the time has passed.
  void wait(std::uint32_t timeout_us) { static_cast<void>(can_.wait(timeout_us)); }

 private:
  hal::SocketCan can_;
  std::string interface_;
};

}  // namespace volcomp::sim
