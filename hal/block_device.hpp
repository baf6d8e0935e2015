#pragma once
// Non-volatile memory in sectors, like NOR flash. Bound at compile time. A board writes one class:
//
//   struct MyBlocks {
//     static constexpr std::size_t kUnitBytes = 32;        // smallest programmable unit
//     static constexpr std::size_t kSectorBytes = 131072;  // smallest erasable unit
//     static constexpr std::size_t kSectors = 2;
//     volcomp::hal::BlockRead read(std::size_t at, volcomp::Span<std::uint8_t> out);
//     bool program(std::size_t at, volcomp::Span<const std::uint8_t> bytes);
//     bool erase(std::size_t sector);
//   };
//
// (The numbers of an STM32H743: flash words of 256 bits, each with its own error correction bits,
// in sectors of 128 KiB.) Addresses count from 0 across all sectors. read() takes any range,
// program() whole units.
//
//   - erase() turns every byte of the sector to 0xFF. Cut short, the sector holds anything.
//   - program() works unit by unit, upwards. A unit is programmed once after an erase, because its
//     error correction bits are programmed with it. Cut short, the unit under work holds anything;
//     those before it are complete, those after it untouched.
//   - What was cut short may read differently every time until the sector is erased again ("The
//     unstable bits issue" in the documentation of UBIFS).
//   - Both return when the data are on the medium. False: the device reported a failure, and what
//     it was working on holds anything. Neither checks its work: the caller reads back.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "comp/core/span.hpp"

namespace volcomp::hal {

enum class [[nodiscard]] BlockRead : std::uint8_t{
    done,
    uncorrectable,  // a unit has more wrong bits than its error correction can mend; `out` is void
    failed,         // the device does not answer
};

template <class Blocks, class = void>
struct IsBlockDevice : std::false_type {};

template <class Blocks>
struct IsBlockDevice<
    Blocks,
    std::void_t<
        decltype(std::size_t{Blocks::kUnitBytes}), decltype(std::size_t{Blocks::kSectorBytes}),
        decltype(std::size_t{Blocks::kSectors}),
        decltype(BlockRead{std::declval<Blocks&>().read(std::size_t{}, Span<std::uint8_t>{})}),
        decltype(bool(std::declval<Blocks&>().program(std::size_t{}, Span<const std::uint8_t>{}))),
        decltype(bool(std::declval<Blocks&>().erase(std::size_t{})))>>
    : std::bool_constant<Blocks::kSectorBytes % Blocks::kUnitBytes == 0> {};

inline constexpr std::uint8_t kErasedByte = 0xFF;

inline bool is_erased(Span<const std::uint8_t> bytes) {
  return std::all_of(bytes.begin(), bytes.end(),
                     [](std::uint8_t byte) { return byte == kErasedByte; });
}

// Every device refuses a range outside of itself, and a program() of anything but whole units.
template <class Blocks>
constexpr bool is_inside(std::size_t at, std::size_t size) {
  constexpr std::size_t kBytes = Blocks::kSectorBytes * Blocks::kSectors;
  return at <= kBytes && size <= kBytes - at;
}

template <class Blocks>
constexpr bool is_whole_units(std::size_t at, std::size_t size) {
  return is_inside<Blocks>(at, size) && at % Blocks::kUnitBytes == 0 &&
         size % Blocks::kUnitBytes == 0;
}

}  // namespace volcomp::hal
