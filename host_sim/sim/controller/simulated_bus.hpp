#pragma once
// Everything on one simulated CAN bus, moved through time together.

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/exchange.hpp"
#include "hal/loopback/loopback_bus.hpp"

namespace volcomp::sim {

// Serves a device as canopen::exchange() does, and leaves out what would do nothing.
class Rest {
 public:
  // When a device is served: as it says; as it says now, functions of it may have been called; or
  // at every opportunity.
  enum class When : std::uint8_t { due, called, always };

  template <class Device, class Port>
  void receive(Device& device, Port& port, std::uint64_t now_us) {
    while (const hal::CanFrame* const next = port.first()) {
      if (!device.heeds(*next)) {
        port.skip();
        continue;
      }
      hal::CanFrame frame;
      port.receive(frame);
      device.receive(frame, now_us);
      // Process data change what is sent, and no other time.
      disturbed_ = disturbed_ || canopen::restricted(frame.id);
      if (!over(now_us)) until_us_ = std::min(until_us_, device.sends_at_us());
    }
  }
  void disturb() { disturbed_ = true; }
  // Until when serve() does nothing, unless a frame arrives or a function of the device is called.
  [[nodiscard]] std::uint64_t until_us() const { return disturbed_ ? 0 : until_us_; }
  // `called`: functions of the device may have been called. Then it is asked anew until when it
  // rests, which is much less work than serving it.
  template <class Device, class Port, class RestsUntil>
  void serve(Device& device, Port& port, std::uint64_t now_us, When when,
             const RestsUntil& rests_until_us) {
    if (when == When::called && !over(now_us)) until_us_ = rests_until_us();
    if (when != When::always && !over(now_us)) return;
    disturbed_ = false;
    canopen::exchange(device, port, now_us);
    until_us_ = rests_until_us();
  }

 private:
  [[nodiscard]] bool over(std::uint64_t now_us) const { return disturbed_ || now_us >= until_us_; }

  bool disturbed_ = false;
  std::uint64_t until_us_ = 0;
};

class SimulatedBus {
 public:
  using Port = hal::LoopbackBus::Port;
  // What a participant does when it gets the processor. Returns until when it rests: before that
  // time it is called only for a frame that has arrived, or in the first round of run_…(). 0: it
  // never rests.
  using Serve = std::function<std::uint64_t(Port& port, std::uint64_t now_us)>;

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
      rest.serve(device, port, now_us, served(), rests_until_us);
      return rest.until_us();
    };
    Port& port = attach_served(name, serve);
    port.set_filter([&device](const hal::CanFrame& frame) { return device.heeds(frame); });
    return port;
  }
  // Three transmit mailboxes, as CAN controllers have. Without `serve` the owner serves the port.
  Port& attach_served(std::string name, Serve serve, std::size_t mailboxes = kMailboxes);
  // The same for what returns nothing: it never rests.
  template <class Unresting>
  Port& attach_served(std::string name, Unresting serve, std::size_t mailboxes = kMailboxes) {
    if constexpr (std::is_void_v<std::invoke_result_t<Unresting&, Port&, std::uint64_t>>) {
      return attach_served(
          std::move(name),
          Serve([serve = std::move(serve)](Port& port, std::uint64_t now_us) mutable {
            serve(port, now_us);
            return std::uint64_t{0};
          }),
          mailboxes);
    } else {
      return attach_served(std::move(name), Serve(std::move(serve)), mailboxes);
    }
  }

  // Devices that rest are served as often as all others, for a comparison.
  void serve_always() { always_ = true; }
  // In the first round of run_…() functions of the devices may have been called since the last.
  [[nodiscard]] Rest::When served() const {
    return always_ ? Rest::When::always : called_ ? Rest::When::called : Rest::When::due;
  }

  [[nodiscard]] std::uint64_t now_us() const { return bus_.now_ns() / 1000U; }

  void run_until(std::uint64_t time_ns);
  // The same where functions of the participant at `called` alone may have been called since.
  void run_until(std::uint64_t time_ns, const Port& called);
  // Runs until no port has a frame to send.
  void run_until_quiet();

  [[nodiscard]] hal::LoopbackBus& bus() { return bus_; }
  [[nodiscard]] const hal::LoopbackBus& bus() const { return bus_; }

 private:
  struct Participant {
    Port* port;
    Serve serve;
    std::uint64_t frames = 0;  // sent and received until it was served last
    std::uint64_t rests_until_us = 0;
  };
  static constexpr std::size_t kMailboxes = 3;
  [[nodiscard]] bool rests(const Participant& p, std::uint64_t now_us) const;
  static void serve(Participant& p, std::uint64_t now_us);
  void serve_all();
  void serve_concerned();
  void first_round();
  void first_round(const Port& called);
  void go_on_until(std::uint64_t time_ns);

  hal::LoopbackBus bus_;
  bool called_ = true;
  bool always_ = false;
  std::uint64_t last_frame_ns_ = 0;
  std::vector<Participant> participants_;
};

}  // namespace volcomp::sim
