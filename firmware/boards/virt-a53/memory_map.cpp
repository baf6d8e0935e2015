#include "firmware/boards/virt-a53/memory_map.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/virt/registers.hpp"

extern "C" {
// Symbols of the linker script: only their addresses count.
extern const char code_begin;
extern const char code_end;
extern const char constants_end;
extern const char data_begin;
extern const char data_end;
extern const char stack_guard;
extern const char interrupt_stack_guard;
extern const char fault_stack_guard;
}

namespace volcomp::boards {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
constexpr std::uint64_t kBlockBytes = kPageBytes * 512;  // one entry of level 2
constexpr std::uint64_t kRam = 0x4000'0000;

// Descriptors of the stage 1 translation (D5.3).
constexpr std::uint64_t kTable = 3;
constexpr std::uint64_t kBlock = 1;
constexpr std::uint64_t kPage = 3;
constexpr std::uint64_t kNormal = 1U << 2U;  // second attribute of kMemoryTypes, else device
constexpr std::uint64_t kReadOnly = 1U << 7U;
constexpr std::uint64_t kInnerShareable = 3U << 8U;
constexpr std::uint64_t kAccessed = 1U << 10U;
constexpr std::uint64_t kNeverExecuted = std::uint64_t{3} << 53U;

constexpr std::uint64_t kMemory = kPage | kNormal | kInnerShareable | kAccessed;
constexpr std::uint64_t kDevice = kBlock | kAccessed | kNeverExecuted;

constexpr std::uint64_t kMemoryTypes = 0xFF04;  // 0: Device-nGnRE; 1: normal, write-back
// 4 GiB from address 0 in pages of 4 KiB, tables cached like memory, no second half.
constexpr std::uint64_t kTranslationControl =
    32U | (1U << 8U) | (1U << 10U) | (3U << 12U) | (1U << 23U);
constexpr std::uint64_t kMmuOn = 1U << 0U;
constexpr std::uint64_t kDataCacheOn = 1U << 2U;
constexpr std::uint64_t kInstructionCacheOn = 1U << 12U;

struct alignas(kPageBytes) Table {
  std::array<std::uint64_t, 512> entry;
};

// Level 1 has an entry per GiB: the devices are in the first, the RAM begins the second.
alignas(64) std::array<std::uint64_t, 4> gigabytes;
Table device_blocks;
Table ram_blocks;
Table ram_pages;

std::uint64_t address(const void* symbol) { return reinterpret_cast<std::uintptr_t>(symbol); }

void map_devices(std::uint64_t at) { device_blocks.entry[at / kBlockBytes] = at | kDevice; }

// The addresses are multiples of a page.
void map_ram(const char* begin, const char* end, std::uint64_t attributes) {
  for (std::uint64_t at = address(begin); at < address(end); at += kPageBytes)
    ram_pages.entry[(at - kRam) / kPageBytes] = at | kMemory | attributes;
}

void unmap(const char& guard) { ram_pages.entry[(address(&guard) - kRam) / kPageBytes] = 0; }

void fill_tables() {
  map_devices(hal::virt::kGicDistributor);
  map_devices(hal::virt::kUart);
  map_devices(hal::virt::kPciPorts / kBlockBytes * kBlockBytes);
  map_devices(hal::virt::kPciConfiguration);
  map_ram(&code_begin, &code_end, kReadOnly);
  map_ram(&code_end, &constants_end, kReadOnly | kNeverExecuted);
  map_ram(&data_begin, &data_end, kNeverExecuted);
  unmap(stack_guard);
  unmap(interrupt_stack_guard);
  unmap(fault_stack_guard);
  ram_blocks.entry[0] = address(&ram_pages) | kTable;
  gigabytes[0] = address(&device_blocks) | kTable;
  gigabytes[1] = address(&ram_blocks) | kTable;
}

}  // namespace

void map_memory() {
  fill_tables();
  std::uint64_t control = 0;
  __asm volatile(
      "msr mair_el1, %0\n"
      "msr tcr_el1, %1\n"
      "msr ttbr0_el1, %2\n"
      "dsb ish\n"
      "tlbi vmalle1\n"
      "dsb ish\n"
      "isb\n" ::"r"(kMemoryTypes),
      "r"(kTranslationControl), "r"(address(&gigabytes))
      : "memory");
  __asm volatile("mrs %0, sctlr_el1" : "=r"(control));
  control |= kMmuOn | kDataCacheOn | kInstructionCacheOn;
  __asm volatile("msr sctlr_el1, %0\n isb" ::"r"(control) : "memory");
}

}  // namespace volcomp::boards
