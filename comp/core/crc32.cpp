#include "comp/core/crc32.hpp"

#include <array>
#include <utility>

#include "comp/core/bytes.hpp"

namespace volcomp {
namespace {

// Bits at a time: 4 take tables of 64 bytes; 64 take 8 KB, for computers: the tables of the eight
// bytes are looked up independently of each other.
#ifdef VOLCOMP_CRC_BITS
constexpr unsigned kBits = VOLCOMP_CRC_BITS;
#else
constexpr unsigned kBits = 4;
#endif
static_assert(kBits == 4 || kBits == 64);
constexpr unsigned kStepBits = kBits == 64 ? 8 : kBits;
constexpr std::size_t kBytes = kBits == 64 ? 8 : 1;

using Steps = std::array<std::uint32_t, 1U << kStepBits>;
using Tables = std::array<Steps, kBytes>;

// tables[n]: what kStepBits bits and n bytes of zeros after them do to the register. The polynomial
// is reflected.
constexpr Tables make_tables(std::uint32_t polynomial) {
  Tables tables{};
  for (std::uint32_t i = 0; i < tables[0].size(); ++i) {
    std::uint32_t crc = i;
    for (unsigned bit = 0; bit < kStepBits; ++bit)
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? polynomial : 0U);
    tables[0][i] = crc;
  }
  for (std::size_t n = 1; n < kBytes; ++n) {
    for (std::size_t i = 0; i < tables[n].size(); ++i) {
      const std::uint32_t crc = tables[n - 1][i];
      tables[n][i] = (crc >> 8U) ^ tables[0][crc & 0xFFU];
    }
  }
  return tables;
}

constexpr Tables kEthernet = make_tables(0xEDB88320U);    // 04C11DB7h
constexpr Tables kCastagnoli = make_tables(0x82F63B78U);  // 1EDC6F41h

// What kBytes bytes make of the register. Written out: a compiler keeps the loop over them, which
// takes twice as long.
template <std::size_t... N>
std::uint32_t look_up(const Tables& tables, std::uint64_t bytes,
                      std::index_sequence<N...> /*numbers*/) {
  return (tables[kBytes - 1 - N][(bytes >> (8U * N)) & 0xFFU] ^ ...);
}

std::uint32_t checksum(const Tables& tables, Span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  std::size_t at = 0;
  if constexpr (kBytes > 1) {
    for (; at + kBytes <= bytes.size(); at += kBytes) {
      const std::uint8_t* next = bytes.data() + at;
      const std::uint64_t all = std::uint64_t{load_u32(next + 4)} << 32U | (load_u32(next) ^ crc);
      crc = look_up(tables, all, std::make_index_sequence<kBytes>{});
    }
  }
  const Steps& steps = tables[0];
  for (; at < bytes.size(); ++at) {
    crc ^= bytes[at];
    for (unsigned bit = 0; bit < 8; bit += kStepBits)
      crc = (crc >> kStepBits) ^ steps[crc & (steps.size() - 1)];
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
