#include "comp/tables/crc32.hpp"

#include <array>

namespace volcomp {
namespace {

// What four bits do to the register, polynomial 04C11DB7h reflected.
constexpr std::array<std::uint32_t, 16> make_steps() {
  std::array<std::uint32_t, 16> steps{};
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 4; ++bit)
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    steps[i] = crc;
  }
  return steps;
}

constexpr std::array<std::uint32_t, 16> kStep = make_steps();

}  // namespace

std::uint32_t crc32(Span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    crc = (crc >> 4U) ^ kStep[crc & 15U];
    crc = (crc >> 4U) ^ kStep[crc & 15U];
  }
  return ~crc;
}

}  // namespace volcomp
