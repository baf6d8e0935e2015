#include "comp/core/crc32.hpp"

#include <array>

namespace volcomp {
namespace {

using Steps = std::array<std::uint32_t, 16>;

// What four bits do to the register. The polynomial is reflected.
constexpr Steps make_steps(std::uint32_t polynomial) {
  Steps steps{};
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 4; ++bit)
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? polynomial : 0U);
    steps[i] = crc;
  }
  return steps;
}

constexpr Steps kEthernet = make_steps(0xEDB88320U);    // 04C11DB7h
constexpr Steps kCastagnoli = make_steps(0x82F63B78U);  // 1EDC6F41h

std::uint32_t checksum(const Steps& steps, Span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    crc = (crc >> 4U) ^ steps[crc & 15U];
    crc = (crc >> 4U) ^ steps[crc & 15U];
  }
  return ~crc;
}

}  // namespace

std::uint32_t crc32(Span<const std::uint8_t> bytes, std::uint32_t before) {
  return checksum(kEthernet, bytes, before);
}

bool PiecewiseCrc::read_on(Span<const std::uint8_t> all, std::size_t most) {
  const std::size_t left = all.size() - done;
  const std::size_t now = left < most ? left : most;
  crc = crc32({all.data() + done, now}, done == 0 ? 0 : crc);
  done = now < left ? done + static_cast<std::uint32_t>(now) : 0;
  return now == left;
}

std::uint32_t crc32c(Span<const std::uint8_t> bytes, std::uint32_t before) {
  return checksum(kCastagnoli, bytes, before);
}

}  // namespace volcomp
