#pragma once
// What a test remembers through the restarts of its processor: a few words of the memory that
// nothing clears, behind the reset cause.

#include <cstdint>

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "hal/mps2/flash_blocks.hpp"

namespace volcomp::test {

class Lives {
 public:
  // Counts this life. Made once, at the start of main.
  Lives() {
    constexpr std::uint32_t kMark = 0x4C49'5645;
    if (word(0) != kMark) {
      word(0) = kMark;
      word(1) = word(2) = word(3) = 0;
    }
    word(1) = word(1) + 1;
  }

  [[nodiscard]] std::uint32_t number() const { return word(1); }  // 1 in the first
  [[nodiscard]] std::uint32_t found_old() const { return word(2); }
  [[nodiscard]] std::uint32_t found_new() const { return word(3); }
  void count_old() { word(2) = word(2) + 1; }
  void count_new() { word(3) = word(3) + 1; }

 private:
  static volatile std::uint32_t& word(std::size_t i) { return retained_begin[16 + i]; }
};

inline Span<std::uint8_t> flash_memory() {
  return {block_memory_begin, hal::mps2::FlashBlocks::kMemoryBytes};
}

}  // namespace volcomp::test
