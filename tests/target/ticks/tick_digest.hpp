#pragma once
// Numbers for everything a run of ticks puts out and counts: equal wherever the arithmetic is.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "comp/tick/tick_types.hpp"

namespace volcomp::target {

// Fowler, Noll, Vo (FNV-1a), a word at a time.
class Digest {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 1'099'511'628'211U; }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14'695'981'039'346'656'037U;
};

struct SearchDigest {
  std::uint64_t outputs = 0;  // every offset, status word and error
  std::uint64_t counts = 0;   // diagnostics

  friend bool operator==(const SearchDigest& a, const SearchDigest& b) {
    return a.outputs == b.outputs && a.counts == b.counts;
  }
};

// Offsets, status words and the error of a tick.
template <class Unit>
void add_outputs(Digest& digest, const Unit& unit, const typename Unit::Output& out,
                 std::size_t axes) {
  for (std::size_t a = 0; a < axes; ++a) {
    digest.add(static_cast<std::uint32_t>(out.offset[a]));
    digest.add(out.status[a]);
  }
  for (const float error_nm : unit.last_error_nm()) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &error_nm, sizeof bits);
    digest.add(bits);
  }
}

// What the diagnostics count. A status bit that never came adds nothing, so that a new one leaves
// the digest as it is.
template <class Unit>
void add_counts(Digest& digest, const Unit& unit, std::size_t axes) {
  const auto counted = unit.diagnostics();
  digest.add(counted.ticks);
  for (std::size_t a = 0; a < axes; ++a) {
    digest.add(static_cast<std::uint32_t>(counted.largest[a]));
    for (std::size_t bit = 0; bit < kStatusBits; ++bit) {
      const std::uint16_t began = counted.began[a][bit];
      if (began != 0) digest.add(static_cast<std::uint32_t>(bit) << 16U | began);
    }
  }
}

}  // namespace volcomp::target
