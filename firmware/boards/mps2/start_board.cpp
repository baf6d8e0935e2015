// What runs between the assembly startup and main, and what follows main.

#include "firmware/boards/mps2/memory_protection.hpp"
#include "hal/mps2/registers.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/uart.hpp"

namespace {

// Without these a fault of memory or program arrives as HardFault, with its cause less distinct
// (DDI 0403, B3.2.13).
void enable_fault_handlers() {
  constexpr std::uint32_t kSystemHandlerControl = 0xE000'ED24;
  constexpr std::uint32_t kUsageBusMemManage = 7U << 16U;
  volcomp::hal::mps2::device_register(kSystemHandlerControl) |= kUsageBusMemManage;
}

// A division by zero faults instead of returning 0 (DDI 0403, B3.2.8).
void trap_division_by_zero() {
  constexpr std::uint32_t kConfigurationControl = 0xE000'ED14;
  constexpr std::uint32_t kDivideByZeroTrap = 1U << 4U;
  volcomp::hal::mps2::device_register(kConfigurationControl) |= kDivideByZeroTrap;
}

}  // namespace

extern "C" void start_board() {
  enable_fault_handlers();
  trap_division_by_zero();
  volcomp::boards::protect_memory();
  volcomp::hal::mps2::uart::start();
  volcomp::hal::mps2::semihosting::find_host();
}

extern "C" [[noreturn]] void end_of_program(int exit_code) {
  volcomp::hal::mps2::semihosting::exit(exit_code);
  for (;;) {
  }
}
