#pragma once
// The loop around a device that does no input or output of its own, once.

#include "hal/can_port.hpp"

namespace volcomp::canopen {

// Hands over what has arrived, lets time pass, sends what there is. A port that is full ends the
// sending: what could not leave is offered again next time, process data then with newer values.
template <class Device, class Port>
void exchange(Device& device, Port& port, std::uint64_t now_us) {
  static_assert(hal::IsCanPort<Port>::value, "see hal/can_port.hpp");
  hal::CanFrame frame;
  while (port.receive(frame))
    device.receive(frame, now_us);
  device.poll(now_us);
  while (device.offer(frame, now_us) && port.send(frame))
    device.taken(now_us);
}

}  // namespace volcomp::canopen
