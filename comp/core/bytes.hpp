#pragma once
// Numbers as little-endian bytes, by shifting, so that images and frames are the same on every
// target; and the bits of floating-point numbers.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "comp/core/inline.hpp"
#include "comp/core/span.hpp"

namespace volcomp {

// The same bits as another type of the same size.
template <class To, class From>
VOLCOMP_INLINE To bit_cast(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to = 0;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

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

// Four bytes, unaligned; compilers make one load of it where the processor can.
inline std::uint32_t load_u32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8U | std::uint32_t{bytes[2]} << 16U |
         std::uint32_t{bytes[3]} << 24U;
}

inline float load_f32(const std::uint8_t* bytes) { return bit_cast<float>(load_u32(bytes)); }

// The caller has made sure that everything fits.
class LittleEndianWriter {
 public:
  explicit LittleEndianWriter(Span<std::uint8_t> bytes) : bytes_(bytes) {}

  void bits(std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      bytes_[at_++] = static_cast<std::uint8_t>(value >> (8U * i));
  }
  void u8(std::uint8_t value) { bits(value, 1); }
  void u32(std::uint32_t value) { bits(value, 4); }
  void i64(std::int64_t value) { bits(static_cast<std::uint64_t>(value), 8); }
  void f32(float value) { bits(bit_cast<std::uint32_t>(value), 4); }
  void f64(double value) { bits(bit_cast<std::uint64_t>(value), 8); }
  template <class Array>
  void f64s(const Array& values) {
    for (const double v : values)
      f64(v);
  }
  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t place) { at_ = place; }

 private:
  Span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// Reads zeros beyond the end and records it.
class LittleEndianReader {
 public:
  explicit LittleEndianReader(Span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t bits(std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t byte = at_ < bytes_.size() ? bytes_[at_] : 0U;
      value |= byte << (8U * i);
      ++at_;
    }
    return value;
  }
  std::uint8_t u8() { return static_cast<std::uint8_t>(bits(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(bits(4)); }
  std::int64_t i64() { return static_cast<std::int64_t>(bits(8)); }
  float f32() { return bit_cast<float>(u32()); }
  double f64() { return bit_cast<double>(bits(8)); }
  template <class Array>
  void f64s(Array& values) {
    for (auto& v : values)
      v = f64();
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  Span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace volcomp
