#include "firmware/boards/mps2/memory_protection.hpp"

#include <array>
#include <cstdint>

#include "hal/mps2/registers.hpp"

extern "C" {
// Made by the linker script: their addresses are meant.
extern std::uint32_t flash_begin;
extern std::uint32_t ram_begin;
extern std::uint32_t block_memory_begin;
extern std::uint32_t stack_guard;
}

namespace volcomp::boards {
namespace {

using hal::mps2::device_register;

constexpr std::uint32_t kControl = 0xE000'ED94;
constexpr std::uint32_t kRegionBase = 0xE000'ED9C;
constexpr std::uint32_t kRegionAttributes = 0xE000'EDA0;

constexpr std::uint32_t kEnableWithoutBackground = 1U << 0U;
constexpr std::uint32_t kBaseNamesRegion = 1U << 4U;

// Region attribute and size register (B3.5.9). Normal memory: TEX 0, C, B as for internal SRAM.
constexpr std::uint32_t kEnable = 1U << 0U;
constexpr std::uint32_t kNormal = 1U << 17U;
constexpr std::uint32_t kDevice = (1U << 18U) | (1U << 16U);
constexpr std::uint32_t kNoAccess = 0U << 24U;
constexpr std::uint32_t kReadWrite = 3U << 24U;
constexpr std::uint32_t kReadOnly = 6U << 24U;
constexpr std::uint32_t kExecuteNever = 1U << 28U;

// Of a region of 2^n bytes.
constexpr std::uint32_t size(std::uint32_t n) { return (n - 1U) << 1U; }

struct Region {
  std::uint32_t base;  // multiple of the size
  std::uint32_t attributes;
};

std::uint32_t address(const std::uint32_t& symbol) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&symbol));
}

}  // namespace

void protect_memory() {
  // Where two overlap, the later one holds.
  const std::array<Region, 6> regions = {{
      {address(flash_begin), kReadOnly | kNormal | size(19) | kEnable},
      {address(ram_begin), kReadWrite | kExecuteNever | kNormal | size(VOLCOMP_RAM_LOG2) | kEnable},
      {address(block_memory_begin), kReadWrite | kExecuteNever | kNormal | size(19) | kEnable},
      {hal::mps2::kTimer0, kReadWrite | kExecuteNever | kDevice | size(16) | kEnable},
      {address(flash_begin), kNoAccess | kExecuteNever | kNormal | size(10) | kEnable},
      {address(stack_guard), kNoAccess | kExecuteNever | kNormal | size(10) | kEnable},
  }};
  std::uint32_t number = 0;
  for (const Region& region : regions) {
    device_register(kRegionBase) = region.base | kBaseNamesRegion | number;
    device_register(kRegionAttributes) = region.attributes;
    ++number;
  }
  device_register(kControl) = kEnableWithoutBackground;
  __asm volatile("dsb\n isb" ::: "memory");
}

}  // namespace volcomp::boards
