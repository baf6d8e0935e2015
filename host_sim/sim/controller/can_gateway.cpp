#include "host_sim/sim/controller/can_gateway.hpp"

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kSendPause_us = 1000;
constexpr int kSendAttempts = 1000;

}  // namespace

void CanGateway::exchange(hal::LoopbackBus::Port& port) {
  hal::CanFrame frame;
  while (port.receive(frame)) {
    int attempts = 0;
    while (!link_.send(frame)) {
      if (++attempts == kSendAttempts) throw host::UserError("the bus accepts no frames");
      wait(kSendPause_us);
    }
  }
  while (link_.receive(frame))
    port.send(frame);
}

}  // namespace volcomp::sim
