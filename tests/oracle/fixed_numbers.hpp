#pragma once
// Numbers that are the same everywhere and always, and a digest of what is computed from them.

#include "comp/core/crc32.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

// Integers, and floats that one division makes of them.
class Fixed {
 public:
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }
  AxisTable table(std::int64_t q0, std::int64_t pitch, std::uint32_t knots, bool periodic = false) {
    AxisTable t;
    t.q0 = q0;
    t.pitch = pitch;
    t.knots = knots;
    t.periodic = periodic;
    for (auto& column : t.value) {
      for (std::uint32_t i = 0; i < knots; ++i) {
        for (std::size_t c = 0; c < 6; ++c) {
          const auto whole = static_cast<float>(integer(-40'000, 40'000));
          column[i][c] = c < 3 ? whole : whole / 1e9F;
        }
      }
    }
    return t;
  }

 private:
  std::mt19937_64 bits_{1};
};

// Digest of integers, least significant byte first.
class Digest {
 public:
  void add(std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
      pending_[at_++] = static_cast<std::uint8_t>(value >> (8U * i));
  }
  // What was added since the last one counts as one record.
  void end_record() {
    digest_ = digest_ * 31U + crc32({pending_.data(), at_});
    at_ = 0;
  }
  [[nodiscard]] std::uint32_t value() const { return digest_; }

 private:
  std::array<std::uint8_t, 96> pending_{};
  std::size_t at_ = 0;
  std::uint32_t digest_ = 0;
};

}  // namespace volcomp::test
