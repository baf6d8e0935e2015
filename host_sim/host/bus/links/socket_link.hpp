#pragma once
// A SocketCAN interface as a link.

#include "hal/linux/socket_can.hpp"
#include "hal/linux/steady_clock.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

class SocketLink final : public FrameLink {
 public:
  // Throws UserError naming the interface.
  explicit SocketLink(const std::string& interface);

  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] bool send_remote(std::uint16_t id, std::uint8_t size) override;
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  void wait(std::uint32_t timeout_us) override { static_cast<void>(can_.wait(timeout_us)); }
  [[nodiscard]] std::uint64_t now_us() const override { return clock_.now_us(); }
  [[nodiscard]] bool turn_by_turn() const override { return false; }

 private:
  void check() const;

  std::string interface_;
  hal::SocketCan can_;
  hal::SteadyClock clock_;
};

}  // namespace volcomp::host
