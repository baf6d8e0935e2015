#pragma once
// A SocketCAN interface as a link.

#include <deque>

#include "hal/linux/socket_can.hpp"
#include "hal/linux/steady_clock.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

class SocketLink final : public FrameLink {
 public:
  // Throws UserError naming the interface.
  explicit SocketLink(const std::string& interface);
  // From now on send() ends when every listener of the interface has the frame: when it has come
  // back. The kernel hands frames of a virtual interface over when it gets to it. Throws UserError
  // naming the interface where the kernel gives none back.
  void await_echoes();

  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] bool send_remote(std::uint16_t id, std::uint8_t size) override;
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  void wait(std::uint32_t timeout_us) override {
    if (arrived_.empty()) static_cast<void>(can_.wait(timeout_us));
  }
  [[nodiscard]] std::uint64_t now_us() const override { return clock_.now_us(); }
  [[nodiscard]] bool turn_by_turn() const override { return false; }

 private:
  void check() const;
  void await_echo();

  std::string interface_;
  hal::SocketCan can_;
  hal::SteadyClock clock_;
  bool echoes_ = false;
  std::deque<hal::CanFrame> arrived_;  // while an echo was awaited
};

}  // namespace volcomp::host
