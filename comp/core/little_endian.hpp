#pragma once
// Numbers as bytes in a fixed order, by shifting, so that an image is the same on every target.

#include <cstdint>
#include <cstring>

#include "comp/core/span.hpp"

namespace volcomp {

// Four bytes, unaligned; compilers make one load of it where the processor can.
inline std::uint32_t load_u32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8U | std::uint32_t{bytes[2]} << 16U |
         std::uint32_t{bytes[3]} << 24U;
}

inline float load_f32(const std::uint8_t* bytes) {
  const std::uint32_t raw = load_u32(bytes);
  float value = 0.0F;
  std::memcpy(&value, &raw, sizeof value);
  return value;
}

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
  void f32(float value) {
    std::uint32_t raw = 0;
    std::memcpy(&raw, &value, sizeof raw);
    bits(raw, 4);
  }
  void f64(double value) {
    std::uint64_t raw = 0;
    std::memcpy(&raw, &value, sizeof raw);
    bits(raw, 8);
  }
  template <class Array>
  void f64s(const Array& values) {
    for (const double v : values)
      f64(v);
  }
  [[nodiscard]] std::size_t at() const { return at_; }

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
  float f32() {
    const auto raw = static_cast<std::uint32_t>(bits(4));
    float value = 0.0F;
    std::memcpy(&value, &raw, sizeof value);
    return value;
  }
  double f64() {
    const std::uint64_t raw = bits(8);
    double value = 0.0;
    std::memcpy(&value, &raw, sizeof value);
    return value;
  }
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
