#include "hal/virt/kvaser_pci.hpp"

namespace volcomp::hal::virt {
namespace {

constexpr std::uint32_t kSlots = 32;
constexpr std::uint32_t kIdentity = 0x8406'10E8;  // device and vendor

// Configuration space (PCI Local Bus Specification 3.0, section 6.1).
constexpr Address kCommand = 0x04;
constexpr Address kBaseAddress0 = 0x10;
constexpr Address kInterruptPin = 0x3D;
constexpr std::uint32_t kPortsEnabled = 1U << 0U;
constexpr std::uint32_t kInterruptDisabled = 1U << 10U;

// Base addresses: the bridge, the chip, a register with the version of the card.
constexpr Address kAreas = 3;
constexpr Address kAreaBytes = 0x80;
constexpr Address kFirstPort = 0x1000;

// The bridge's interrupt control register (AMCC S5920 data book, INTCSR).
constexpr Address kInterruptControl = 0x38;
constexpr std::uint32_t kAddOnInterruptEnabled = 1U << 13U;

Address configuration(std::uint32_t slot) { return kPciConfiguration + (Address{slot} << 15U); }

// Gives the areas of a card ports of its own and switches them on.
void assign_ports(std::uint32_t slot, Address first_port) {
  for (Address area = 0; area < kAreas; ++area) {
    const Address port = first_port + area * kAreaBytes;
    word_register(configuration(slot) + kBaseAddress0 + 4U * area) =
        static_cast<std::uint32_t>(port);
  }
  volatile std::uint32_t& command = word_register(configuration(slot) + kCommand);
  command = (command & ~kInterruptDisabled) | kPortsEnabled;
}

// The four lines are dealt out in turn (PCI-to-PCI Bridge Specification 1.2, table 9-1).
std::uint32_t interrupt_of(std::uint32_t slot) {
  const std::uint32_t pin = byte_register(configuration(slot) + kInterruptPin);  // 1 = INTA
  return kPciInterrupts + (slot + pin - 1U) % 4U;
}

}  // namespace

std::size_t find_kvaser_cards(Span<KvaserCard> cards) {
  std::size_t found = 0;
  for (std::uint32_t slot = 0; slot < kSlots && found < cards.size(); ++slot) {
    if (word_register(configuration(slot)) != kIdentity) continue;
    const Address first_port = kFirstPort + found * kAreas * kAreaBytes;
    assign_ports(slot, first_port);
    word_register(kPciPorts + first_port + kInterruptControl) = kAddOnInterruptEnabled;
    cards[found++] = {kPciPorts + first_port + kAreaBytes, interrupt_of(slot)};
  }
  return found;
}

}  // namespace volcomp::hal::virt
