#pragma once
// Where the devices of QEMU's machine "virt" live when it is started with highmem=off (its source
// hw/arm/virt.c is the only specification).

#include <cstdint>

namespace volcomp::hal::virt {

using Address = std::uintptr_t;

inline constexpr Address kGicDistributor = 0x0800'0000;
inline constexpr Address kGicInterface = 0x0801'0000;
inline constexpr Address kUart = 0x0900'0000;
inline constexpr Address kPciPorts = 0x3EFF'0000;          // 64 KiB of PCI input and output ports
inline constexpr Address kPciConfiguration = 0x3F00'0000;  // ECAM, 1 MiB per bus

// Numbers of the interrupts at the GIC: shared ones begin at 32.
inline constexpr std::uint32_t kVirtualTimerInterrupt = 27;
inline constexpr std::uint32_t kPhysicalTimerInterrupt = 30;
inline constexpr std::uint32_t kPciInterrupts = 35;  // four lines, INTA of slot 0 on the first

// The two places where a number becomes a device register.
inline volatile std::uint32_t& word_register(Address address) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
inline volatile std::uint8_t& byte_register(Address address) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  return *reinterpret_cast<volatile std::uint8_t*>(address);
}

}  // namespace volcomp::hal::virt
