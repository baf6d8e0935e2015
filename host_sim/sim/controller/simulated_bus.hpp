#pragma once
// Everything on one simulated CAN bus, moved through time together.

#include <algorithm>
#include <functional>
#include <vector>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/exchange.hpp"
#include "hal/loopback/loopback_bus.hpp"

namespace volcomp::sim {

// Serves a device as canopen::exchange() does, and leaves out what would do nothing.
class Rest {
 public:
  template <class Device, class Port>
  void receive(Device& device, Port& port, std::uint64_t now_us) {
    hal::CanFrame frame;
    while (port.receive(frame)) {
      if (!device.heeds(frame)) continue;
      device.receive(frame, now_us);
      // Process data change what is sent, and no other time.
      disturbed_ = disturbed_ || canopen::restricted(frame.id);
      until_us_ = std::min(until_us_, device.sends_at_us());
    }
  }
  void disturb() { disturbed_ = true; }
  // `called`: functions of the device may have been called.
  [[nodiscard]] bool over(std::uint64_t now_us, bool called) const {
    return called || disturbed_ || now_us >= until_us_;
  }
  template <class Device, class Port, class RestsUntil>
  void serve(Device& device, Port& port, std::uint64_t now_us, const RestsUntil& rests_until_us) {
    disturbed_ = false;
    canopen::exchange(device, port, now_us);
    until_us_ = rests_until_us();
  }

 private:
  bool disturbed_ = false;
  std::uint64_t until_us_ = 0;
};

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
  // The same for a device that tells what it heeds and when it has something to do
  // (canopen::DeviceBase; `rests_until_us`): the same frames at the same times, for less work.
  // Functions of the device may be called between two calls of run_…(); meanwhile only frames and
  // time reach it.
  template <class Device, class RestsUntil>
  Port& attach_resting(Device& device, const std::string& name, RestsUntil rests_until_us) {
    const auto serve = [this, &device, rests_until_us, rest = Rest()](
                           Port& port, std::uint64_t now_us) mutable {
      rest.receive(device, port, now_us);
      if (rest.over(now_us, called_)) rest.serve(device, port, now_us, rests_until_us);
    };
    return attach_served(name, serve);
  }
  // Three transmit mailboxes, as CAN controllers have. Without `serve` the owner serves the port.
  Port& attach_served(std::string name, Serve serve, std::size_t mailboxes = 3);

  // Devices that rest are served as often as all others, for a comparison.
  void serve_always() { always_ = true; }
  // In the first round of run_…(): functions of the devices may have been called since the last.
  [[nodiscard]] bool called() const { return called_; }

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

  void first_round();

  hal::LoopbackBus bus_;
  bool called_ = true;
  bool always_ = false;
  std::uint64_t last_frame_ns_ = 0;
  std::vector<Participant> participants_;
};

}  // namespace volcomp::sim
