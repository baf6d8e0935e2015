#pragma once
// What an image does in an interrupt. It defines these two; each is called with all other
// interrupts kept out.

#include <cstdint>

namespace volcomp::boards {

// The periodic timer and its alarm; acknowledge() tells them apart.
void on_tick();

// One of the four PCI lines, by its number at the GIC (hal/virt/registers.hpp). The devices behind
// it have to withdraw their request.
void on_pci_interrupt(std::uint32_t id);

}  // namespace volcomp::boards
