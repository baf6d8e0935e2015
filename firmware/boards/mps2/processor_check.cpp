// An image for another processor would end in a fault of its first double instruction, or worse,
// nearly work. This runs before the FPU is on and before .data and .bss exist.

#include "firmware/boards/mps2/exit_code.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/registers.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/uart.hpp"

namespace {

using volcomp::hal::mps2::device_register;
namespace console = volcomp::hal::mps2::console;

constexpr std::uint32_t kCpuId = 0xE000'ED00;           // DDI 0403, B3.2.3
constexpr std::uint32_t kMediaFeatures0 = 0xE000'EF40;  // MVFR0, B4.7
constexpr std::uint32_t kCortexM4 = 0xC24;
constexpr std::uint32_t kCortexM7 = 0xC27;

#if VOLCOMP_BOARD_m7
constexpr std::uint32_t kPart = kCortexM7;
constexpr bool kDoubleInHardware = true;
constexpr const char* kBuiltFor = "Cortex-M7 with double-precision FPU";
#else
constexpr std::uint32_t kPart = kCortexM4;
constexpr bool kDoubleInHardware = false;
constexpr const char* kBuiltFor = "Cortex-M4F";
#endif

std::uint32_t part_number() { return (device_register(kCpuId) >> 4U) & 0xFFFU; }

bool double_in_hardware() { return ((device_register(kMediaFeatures0) >> 8U) & 0xFU) != 0; }

const char* part_name(std::uint32_t part) {
  if (part == kCortexM4) return "Cortex-M4";
  if (part == kCortexM7) return "Cortex-M7";
  return "processor this program does not know";
}

}  // namespace

extern "C" void check_processor() {
  if (part_number() == kPart && double_in_hardware() == kDoubleInHardware) return;
  volcomp::hal::mps2::uart::start();
  console::put("WRONG PROCESSOR: this image is built for a ");
  console::put(kBuiltFor);
  console::put("; this is a ");
  console::put(part_name(part_number()));
  console::put(double_in_hardware() ? " with" : " without");
  console::put(" double-precision FPU (CPUID ");
  console::put_hex(device_register(kCpuId));
  console::put(", MVFR0 ");
  console::put_hex(device_register(kMediaFeatures0));
  console::put("). Nothing was started.\n");
  volcomp::hal::mps2::semihosting::exit(volcomp::boards::kWrongProcessor);
  for (;;) {
  }
}
