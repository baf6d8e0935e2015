#pragma once
// The block device of hal/block_device.hpp for the emulated boards: a model of flash in memory that
// neither the loader nor the startup code touches. Its content survives every reset of the
// processor and ends with the emulator.
//
// Erased, programmed and cut short as flash is: a program() that is not of whole, erased units is
// refused whole, because it is a mistake of the store above.
// Units as in an STM32H743, sectors of half its size: both have to be read at every start.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "hal/block_device.hpp"

namespace volcomp::hal::mps2 {

class FlashBlocks {
 public:
  static constexpr std::size_t kUnitBytes = 32;
  static constexpr std::size_t kSectorBytes = std::size_t{64} * 1024;
  static constexpr std::size_t kSectors = 2;
  static constexpr std::size_t kBytes = kSectorBytes * kSectors;
  static constexpr std::size_t kMemoryBytes = kBytes + kUnitBytes;  // with its mark

  // The memory to use, from now on and after every reset; what was never used before is erased.
  // False, and every other call fails: it has fewer than kMemoryBytes.
  [[nodiscard]] bool attach(Span<std::uint8_t> memory);

  // All fail when the range leaves the device.
  BlockRead read(std::size_t at, Span<std::uint8_t> out) const;
  bool program(std::size_t at, Span<const std::uint8_t> bytes);
  bool erase(std::size_t sector);

 private:
  [[nodiscard]] bool used_before() const;
  void mark_used();

  std::uint8_t* memory_ = nullptr;
};

}  // namespace volcomp::hal::mps2
