#pragma once

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp {

// Both by a table, a few bits at a time: background only. `before`: the checksum of what comes
// before these bytes, 0 for nothing.
//
// Two of them, because a CRC cannot hold what ends with a CRC of the same polynomial: data followed
// by their own CRC-32 have the CRC-32 2144DF1Ch, whatever the data are.

// CRC-32/ISO-HDLC (zlib, Ethernet). crc32("123456789") = 0xCBF43926.
[[nodiscard]] std::uint32_t crc32(Span<const std::uint8_t> bytes, std::uint32_t before = 0);

// A CRC-32 of bytes that are read in pieces, again and again.
struct PiecewiseCrc {
  std::uint32_t done = 0;  // bytes
  std::uint32_t crc = 0;   // of these

  // Reads on in `all`, at most `most` bytes. True at the end: `crc` is that of all of it, and the
  // next call begins anew.
  bool read_on(Span<const std::uint8_t> all, std::size_t most);
};

// CRC-32/ISCSI (Castagnoli, RFC 3720). crc32c("123456789") = 0xE3069283.
[[nodiscard]] std::uint32_t crc32c(Span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace volcomp
