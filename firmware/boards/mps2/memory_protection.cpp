#include "firmware/boards/mps2/memory_protection.hpp"

#include <array>
#include <cstdint>

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "hal/mps2/registers.hpp"

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

// Encodes the size of a region of 2^n bytes.
constexpr std::uint32_t size(std::uint32_t n) { return (n - 1U) << 1U; }

struct Region {
  std::uint32_t base;  // multiple of the size
  std::uint32_t attributes;
};

}  // namespace

void protect_memory() {
  // Where two overlap, the later one holds.
  const std::array<Region, 6> regions = {{
      {address_of(flash_begin), kReadOnly | kNormal | size(address_of(flash_log2)) | kEnable},
      {address_of(ram_begin),
       kReadWrite | kExecuteNever | kNormal | size(address_of(ram_log2)) | kEnable},
      {address_of(block_memory_begin), kReadWrite | kExecuteNever | kNormal | size(19) | kEnable},
      {hal::mps2::kTimer0, kReadWrite | kExecuteNever | kDevice | size(16) | kEnable},
      {address_of(flash_begin), kNoAccess | kExecuteNever | kNormal | size(10) | kEnable},
      {address_of(stack_guard), kNoAccess | kExecuteNever | kNormal | size(10) | kEnable},
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
