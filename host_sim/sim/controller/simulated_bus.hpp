#pragma once
// Everything on one simulated CAN bus, moved through time together.

#include <functional>
#include <vector>

#include "firmware/canopen/exchange.hpp"
#include "hal/loopback/loopback_bus.hpp"

namespace volcomp::sim {

class SimulatedBus {
 public:
  using Port = hal::LoopbackBus::Port;
  // What a participant does when it gets the processor.
  using Serve = std::function<void(Port& port, std::uint64_t now_us)>;

  explicit SimulatedBus(hal::FrameLength length = hal::FrameLength::nominal)
      : bus_(1'000'000, length) {}

  // Adds whatever has the members exchange() needs; it must outlive the bus.
  template <class Device>
  Port& attach(Device& device, const std::string& name) {
    return attach_served(name, [&device](Port& port, std::uint64_t now_us) {
      canopen::exchange(device, port, now_us);
    });
  }
  // Three transmit mailboxes, as CAN controllers have. Without `serve` the owner serves the port.
  Port& attach_served(std::string name, Serve serve, std::size_t mailboxes = 3);

  [[nodiscard]] std::uint64_t now_us() const { return bus_.now_ns() / 1000U; }

  void run_until(std::uint64_t time_ns);
  // Runs until no port has a frame to send.
  void run_until_quiet();

  [[nodiscard]] hal::LoopbackBus& bus() { return bus_; }
  [[nodiscard]] const hal::LoopbackBus& bus() const { return bus_; }

 private:
  struct Participant {
    Port* port;
    Serve serve;
    std::uint64_t sent = 0;
  };
  void serve_all();
  void serve_concerned();

  hal::LoopbackBus bus_;
  std::uint64_t last_frame_ns_ = 0;
  std::vector<Participant> participants_;
};

}  // namespace volcomp::sim
