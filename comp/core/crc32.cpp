#include "comp/core/crc32.hpp"

#include <array>

namespace volcomp {
namespace {

// Bits at a time: 4 take tables of 64 bytes; 8 take 1 KB and half the time, for computers.
#ifdef VOLCOMP_CRC_BITS
constexpr unsigned kBits = VOLCOMP_CRC_BITS;
#else
constexpr unsigned kBits = 4;
#endif
static_assert(kBits == 4 || kBits == 8);

using Steps = std::array<std::uint32_t, 1U << kBits>;

// What kBits bits do to the register. The polynomial is reflected.
constexpr Steps make_steps(std::uint32_t polynomial) {
  Steps steps{};
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    std::uint32_t crc = i;
    for (unsigned bit = 0; bit < kBits; ++bit)
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
    for (unsigned bit = 0; bit < 8; bit += kBits)
      crc = (crc >> kBits) ^ steps[crc & (steps.size() - 1)];
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
