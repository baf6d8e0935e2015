#include "host_sim/controller/can_gateway.hpp"

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kSendPause_us = 1000;
constexpr int kSendAttempts = 1000;

}  // namespace

CanGateway::CanGateway(const std::string& interface) : interface_(interface) {
  const hal::OpenStatus status = can_.open(interface.c_str());
  if (!status.ok()) throw UserError(interface + ": " + hal::sentence(status.result));
}

void CanGateway::exchange(hal::LoopbackBus::Port& port) {
  hal::CanFrame frame;
  while (port.receive(frame)) {
    int attempts = 0;
    while (!can_.send(frame)) {
      if (can_.network_down()) throw UserError(interface_ + ": the interface is down");
      if (++attempts == kSendAttempts) throw UserError(interface_ + ": the bus accepts no frames");
      wait(kSendPause_us);
    }
  }
  while (can_.receive(frame))
    port.send(frame);
}

}  // namespace volcomp::sim
