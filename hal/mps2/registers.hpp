#pragma once
// Where the devices of the MPS2 boards live. AN385, AN386 and AN500 share one map (Arm application
// notes DAI 0385, 0386, 0500, chapter "memory map"); everything runs from one clock.

#include <cstdint>

namespace volcomp::hal::mps2 {

inline constexpr std::uint32_t kClock_Hz = 25'000'000;
inline constexpr std::uint32_t kClock_MHz = 25;

inline constexpr std::uint32_t kTimer0 = 0x4000'0000;
inline constexpr std::uint32_t kTimer1 = 0x4000'1000;
inline constexpr std::uint32_t kDualTimer = 0x4000'2000;
inline constexpr std::uint32_t kUart0 = 0x4000'4000;
inline constexpr std::uint32_t kWatchdog = 0x4000'8000;

// Numbers of the interrupts at the NVIC.
inline constexpr std::uint32_t kUart0ReceiveIrq = 0;
inline constexpr std::uint32_t kUart0TransmitIrq = 1;
inline constexpr std::uint32_t kTimer0Irq = 8;
inline constexpr std::uint32_t kTimer1Irq = 9;

// The one place where a number becomes a device register.
inline volatile std::uint32_t& device_register(std::uintptr_t address) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace volcomp::hal::mps2
