#include "firmware/boards/mps2/call_trace.hpp"

#include "firmware/boards/mps2/linker_symbols.hpp"

namespace volcomp::boards {
namespace {

// Encodings of DDI 0403, A7.7.18 (BL) and A7.7.19 (BLX).
bool is_long_call(std::uint16_t first, std::uint16_t second) {
  return (first & 0xF800U) == 0xF000U && (second & 0xD000U) == 0xD000U;
}
bool is_register_call(std::uint16_t instruction) { return (instruction & 0xFF87U) == 0x4780U; }

bool follows_call(std::uint32_t address) {
  if ((address & 1U) == 0) return false;  // return addresses carry the Thumb bit
  if (address < address_of(code_begin) + 5U || address > address_of(code_end) + 1U) return false;
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* const next = reinterpret_cast<const std::uint16_t*>(address - 1U);
  return is_long_call(next[-2], next[-1]) || is_register_call(next[-1]);
}

}  // namespace

std::uint32_t next_return_address(const std::uint32_t*& word) {
  while (word < stack_top) {
    const std::uint32_t candidate = *word;
    ++word;
    if (follows_call(candidate)) return candidate;
  }
  return 0;
}

}  // namespace volcomp::boards
