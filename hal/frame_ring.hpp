#pragma once
// Frames between an interrupt and the program it interrupts.

#include "hal/can_port.hpp"
#include "hal/ring.hpp"

namespace volcomp::hal {

template <std::size_t Capacity>
using FrameRing = Ring<CanFrame, Capacity>;

}  // namespace volcomp::hal
