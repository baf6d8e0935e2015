#pragma once
// Rows of an object dictionary as written in the source, with the names and texts for people and
// tools. Devices carry the rows of DictionaryOf, without names, which would not fit their flash.

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/canopen/object_dictionary.hpp"

namespace volcomp::canopen {

// As Entry; `capacity` of a visible string in bytes; `low` and `high` of a writable integer,
// inclusive, low > high: the whole type.
struct NamedEntry {
  std::uint16_t index = 0;
  std::uint8_t first_sub = 0;
  std::uint8_t last_sub = 0;
  DataType type = DataType::unsigned8;
  Access access = Access::read_only;
  std::uint8_t traits = kPlain;
  std::uint16_t offset = 0;
  std::uint16_t capacity = 0;
  const char* name = "";
  std::int64_t low = 0;
  std::int64_t high = -1;

  [[nodiscard]] constexpr bool limited() const { return low <= high; }
  [[nodiscard]] constexpr bool has(Trait trait) const { return (traits & trait) != 0; }
  [[nodiscard]] constexpr bool writable() const {
    return access == Access::write_only || access == Access::read_write;
  }
};

namespace detail {

// The first row with the same range.
template <std::size_t Rows>
constexpr std::size_t first_like(const std::array<NamedEntry, Rows>& named, std::size_t row) {
  for (std::size_t i = 0; i < row; ++i) {
    if (named[i].low == named[row].low && named[i].high == named[row].high) return i;
  }
  return row;
}

template <std::size_t Rows>
constexpr bool brings_range(const std::array<NamedEntry, Rows>& named, std::size_t row) {
  return named[row].limited() && first_like(named, row) == row;
}

template <std::size_t Rows>
constexpr std::size_t ranges_before(const std::array<NamedEntry, Rows>& named, std::size_t row) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < row; ++i)
    count += brings_range(named, i) ? 1U : 0U;
  return count;
}

template <std::size_t Ranges, std::size_t Rows>
constexpr std::array<Range, Ranges> ranges_of(const std::array<NamedEntry, Rows>& named) {
  std::array<Range, Ranges> ranges{};
  for (std::size_t i = 0; i < Rows; ++i) {
    if (brings_range(named, i)) ranges[ranges_before(named, i)] = {named[i].low, named[i].high};
  }
  return ranges;
}

// At most 255 ranges, strings of at most 255 bytes, values of at most 8 KiB.
template <std::size_t Rows>
constexpr std::array<Entry, Rows> rows_of(const std::array<NamedEntry, Rows>& named) {
  std::array<Entry, Rows> rows{};
  for (std::size_t i = 0; i < Rows; ++i) {
    const NamedEntry& n = named[i];
    const std::size_t extra =
        n.limited() ? ranges_before(named, first_like(named, i)) + 1 : n.capacity;
    rows[i].index = n.index;
    rows[i].first_sub = n.first_sub;
    rows[i].last_sub = n.last_sub;
    rows[i].offset = n.offset & 0x1FFFU;
    rows[i].extra = extra & 0xFFU;
    rows[i].type_bits = static_cast<std::uint32_t>(n.type) & 0x1FU;
    rows[i].access_bits = static_cast<std::uint32_t>(n.access) & 0x3U;
    rows[i].traits = n.traits & 0xFU;
  }
  return rows;
}

template <std::size_t Rows>
constexpr bool fits(const std::array<NamedEntry, Rows>& named) {
  for (const NamedEntry& n : named) {
    if (n.offset > 0x1FFFU || n.capacity > 0xFFU) return false;
  }
  return ranges_before(named, Rows) <= 0xFFU;
}

}  // namespace detail

// What a device carries, made while compiling: each range is there once.
template <const auto& named>
class DictionaryOf {
  static_assert(detail::fits(named));
  static constexpr auto ranges_ =
      detail::ranges_of<detail::ranges_before(named, named.size())>(named);
  static constexpr auto rows_ = detail::rows_of(named);

 public:
  static constexpr Dictionary value{rows_, ranges_.data()};
};

}  // namespace volcomp::canopen
