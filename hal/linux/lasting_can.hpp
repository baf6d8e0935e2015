#pragma once
// A SocketCAN port that outlives its interface. An adapter that is pulled out or `ip link del`
// takes the interface from under the socket, which then receives nothing more: the port opens it
// again by its name when it is back.

#include <cstdint>
#include <string>

#include "hal/linux/socket_can.hpp"

namespace volcomp::hal {

class LastingCan {
 public:
  static constexpr std::uint64_t kRetry_us = 200'000;

  // As SocketCan::open().
  OpenStatus open(const char* interface) {
    name_ = interface;
    lost_ = false;
    return can_.open(interface);
  }

  enum class News : std::uint8_t { none, lost, back };
  // After every turn. The interface is gone or down, or it is there and up again: each reported
  // once.
  [[nodiscard]] News supervise(std::uint64_t now_us) {
    if (!lost_ && can_.network_down()) {
      lost_ = true;
      tried_us_ = now_us;
      return News::lost;
    }
    if (!lost_ || now_us - tried_us_ < kRetry_us) return News::none;
    tried_us_ = now_us;
    lost_ = !can_.open(name_.c_str()).ok();
    return lost_ ? News::none : News::back;
  }

  // As those of SocketCan; while the interface is lost nothing is sent or received.
  bool send(const CanFrame& frame) { return can_.send(frame); }
  bool receive(CanFrame& frame) { return can_.receive(frame); }
  [[nodiscard]] bool wait(std::uint32_t timeout_us) const { return can_.wait(timeout_us); }
  [[nodiscard]] CanBusState bus_state() const { return can_.bus_state(); }

 private:
  SocketCan can_;
  std::string name_;
  std::uint64_t tried_us_ = 0;
  bool lost_ = false;
};

}  // namespace volcomp::hal
