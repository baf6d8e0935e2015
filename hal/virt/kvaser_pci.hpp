#pragma once
// Kvaser PCIcan cards: one SJA1000 behind an AMCC S5920 bridge, as QEMU models them (device
// kvaser_pci; real cards carry up to four). No firmware has touched the PCI bus before: this gives
// the cards their addresses.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "hal/sja1000/sja1000.hpp"
#include "hal/virt/interrupt_lock.hpp"
#include "hal/virt/registers.hpp"

namespace volcomp::hal::virt {

struct KvaserCard {
  Address sja1000 = 0;
  std::uint32_t interrupt = 0;  // at the GIC; cards four slots apart share one
};

// All cards on PCI bus 0 in the order of their slots, as many as fit; returns how many. Their
// interrupts pass from then on. Once.
std::size_t find_kvaser_cards(Span<KvaserCard> cards);

// How the driver reaches the chip: one byte per register.
struct KvaserRegisters {
  [[nodiscard]] std::uint8_t read(std::uint8_t at) const { return byte_register(base + at); }
  void write(std::uint8_t at, std::uint8_t value) const { byte_register(base + at) = value; }
  Address base = 0;
};

using KvaserCan = Sja1000<KvaserRegisters, InterruptLock>;

// 1 Mbit/s from the card's 16 MHz: the chip halves them, 8 time quanta, sample point at 75 % (CiA
// 301, table 1). Push-pull output; input comparator bypassed, clock output at full rate for a
// second chip, as the card is wired.
inline constexpr Sja1000Settings kKvaser1Mbit{0x00, 0x14, 0xDA, 0x47};

}  // namespace volcomp::hal::virt
