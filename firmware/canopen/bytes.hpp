#pragma once
// Little-endian values in byte strings, as CANopen puts them on the bus.

#include <cstddef>
#include <cstdint>

namespace volcomp::canopen {

// Up to 8 bytes as an unsigned number.
constexpr std::uint64_t load_le(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= std::uint64_t{bytes[i]} << (8U * i);
  return value;
}

constexpr void store_le(std::uint8_t* bytes, std::size_t count, std::uint64_t value) {
  for (std::size_t i = 0; i < count; ++i)
    bytes[i] = static_cast<std::uint8_t>(value >> (8U * i));
}

// The same, sign-extended from `count` bytes, 1…8.
constexpr std::int64_t load_le_signed(const std::uint8_t* bytes, std::size_t count) {
  if (count == 0) return 0;
  const unsigned unused = 64U - 8U * static_cast<unsigned>(count);
  return static_cast<std::int64_t>(load_le(bytes, count) << unused) >> unused;
}

}  // namespace volcomp::canopen
