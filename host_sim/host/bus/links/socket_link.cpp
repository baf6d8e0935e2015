#include "host_sim/host/bus/links/socket_link.hpp"

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

SocketLink::SocketLink(const std::string& interface) : interface_(interface) {
  const hal::OpenStatus status = can_.open(interface.c_str());
  if (!status.ok()) throw UserError(interface + ": " + hal::sentence(status));
}

bool SocketLink::send(const hal::CanFrame& frame) {
  const bool sent = can_.send(frame);
  if (!sent) check();
  return sent;
}

bool SocketLink::send_remote(std::uint16_t id, std::uint8_t size) {
  const bool sent = can_.send_remote(id, size);
  if (!sent) check();
  return sent;
}

bool SocketLink::receive(hal::CanFrame& frame) {
  const bool received = can_.receive(frame);
  if (!received) check();
  return received;
}

void SocketLink::check() const {
  if (can_.network_down()) throw UserError(interface_ + ": the interface is down");
}

}  // namespace volcomp::host
