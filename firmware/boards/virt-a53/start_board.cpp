// What runs between the assembly startup and main, and what follows main.

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "firmware/boards/virt-a53/memory_map.hpp"
#include "hal/virt/gic.hpp"
#include "hal/virt/interrupt_lock.hpp"
#include "hal/virt/semihosting.hpp"
#include "hal/virt/uart.hpp"

extern "C" void start_board() {
  volcomp::boards::map_memory();
  volcomp::hal::virt::uart::start();
  volcomp::hal::virt::gic::start();
}

extern "C" [[noreturn]] void end_of_program(int exit_code) {
  volcomp::hal::virt::semihosting::exit(exit_code);
  __asm volatile("msr daifset, #2");
  for (;;)
    volcomp::hal::virt::wait_for_interrupt();
}
