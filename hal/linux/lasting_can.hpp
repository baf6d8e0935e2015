#pragma once
// A SocketCAN port that outlives its interface. An adapter that is pulled out or `ip link del`
// takes the interface from under the socket, which then receives nothing more: the port opens it
// again by its name when it is back.

#include <algorithm>
#include <array>
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
    if (!lost_ && hears_own_) static_cast<void>(can_.hear_own());
    if (!lost_ && filtered_) static_cast<void>(hear_only({ids_.data(), count_}));
    return lost_ ? News::none : News::back;
  }

  // As those of SocketCan; while the interface is lost nothing is sent or received.
  bool send(const CanFrame& frame) { return can_.send(frame); }
  bool receive(CanFrame& frame) { return can_.receive(frame); }
  [[nodiscard]] std::uint32_t age_us() const { return can_.age_us(); }
  // As SocketCan::hear_only(), also after the interface has come back.
  bool hear_only(Span<const std::uint16_t> ids) {
    filtered_ = ids.size() <= ids_.size() && can_.hear_only(ids);
    if (!filtered_) return false;
    count_ = ids.size();
    std::copy(ids.begin(), ids.end(), ids_.begin());
    return true;
  }
  // As SocketCan::hear_own(), also after the interface has come back.
  bool hear_own() {
    hears_own_ = can_.hear_own();
    return hears_own_;
  }
  [[nodiscard]] bool own() const { return can_.own(); }
  [[nodiscard]] std::uint32_t take_errors() { return can_.take_errors(); }
  [[nodiscard]] std::uint32_t take_losses() { return can_.take_losses(); }
  [[nodiscard]] bool wait(std::uint32_t timeout_us) const { return can_.wait(timeout_us); }
  [[nodiscard]] CanBusState bus_state() const { return can_.bus_state(); }

 private:
  SocketCan can_;
  std::string name_;
  std::array<std::uint16_t, SocketCan::kMostFilters> ids_{};
  std::size_t count_ = 0;
  bool filtered_ = false;
  bool hears_own_ = false;
  std::uint64_t tried_us_ = 0;
  bool lost_ = false;
};

}  // namespace volcomp::hal
