#include "firmware/boards/virt-a53/interrupts.hpp"

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "hal/virt/gic.hpp"
#include "hal/virt/uart.hpp"

namespace {

namespace gic = volcomp::hal::virt::gic;
using volcomp::hal::virt::kPciInterrupts;
using volcomp::hal::virt::kVirtualTimerInterrupt;

[[noreturn]] void report_unexpected(std::uint32_t id) {
  volcomp::hal::virt::uart::start();
  volcomp::hal::virt::uart::put("\nUNEXPECTED INTERRUPT: nobody handles number ");
  volcomp::hal::virt::uart::put_unsigned(id);
  volcomp::hal::virt::uart::put("\n");
  end_of_program(volcomp::boards::kUnexpectedInterrupt);
}

}  // namespace

// From start.S.
extern "C" void handle_interrupt() {
  const std::uint32_t id = gic::acknowledge();
  if (id == gic::kNone) return;
  if (id == kVirtualTimerInterrupt) {
    volcomp::boards::on_tick();
  } else if (id >= kPciInterrupts && id < kPciInterrupts + 4U) {
    volcomp::boards::on_pci_interrupt(id);
  } else {
    report_unexpected(id);
  }
  gic::finish(id);
}
