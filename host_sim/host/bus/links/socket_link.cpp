#include "host_sim/host/bus/links/socket_link.hpp"

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

SocketLink::SocketLink(const std::string& interface) : interface_(interface) {
  const hal::OpenStatus status = can_.open(interface.c_str());
  if (!status.ok()) throw UserError(interface + ": " + hal::sentence(status));
}

void SocketLink::await_echoes() {
  if (!can_.hear_own()) throw UserError(interface_ + ": the kernel gives no sent frames back");
  echoes_ = true;
}

bool SocketLink::send(const hal::CanFrame& frame) {
  const bool sent = can_.send(frame);
  if (!sent) check();
  if (sent && echoes_) await_echo();
  return sent;
}

void SocketLink::await_echo() {
  constexpr std::uint64_t kEchoPatience_us = 10'000'000;
  constexpr std::uint32_t kEchoLook_us = 100'000;
  const std::uint64_t until_us = now_us() + kEchoPatience_us;
  hal::CanFrame frame;
  for (;;) {
    if (can_.receive(frame)) {
      if (can_.own()) return;
      arrived_.push_back(frame);
      continue;
    }
    check();
    if (now_us() > until_us) throw UserError(interface_ + ": a sent frame does not come back");
    static_cast<void>(can_.wait(kEchoLook_us));
  }
}

bool SocketLink::send_remote(std::uint16_t id, std::uint8_t size) {
  const bool sent = can_.send_remote(id, size);
  if (!sent) check();
  return sent;
}

bool SocketLink::receive(hal::CanFrame& frame) {
  if (!arrived_.empty()) {
    frame = arrived_.front();
    arrived_.pop_front();
    return true;
  }
  const bool received = can_.receive(frame);
  if (!received) check();
  return received;
}

void SocketLink::check() const {
  if (can_.network_down()) throw UserError(interface_ + ": the interface is down");
}

}  // namespace volcomp::host
