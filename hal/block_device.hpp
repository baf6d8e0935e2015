#pragma once
// Non-volatile memory in sectors, like NOR flash. Bound at compile time. A board writes one class:
//
//   struct MyBlocks {
//     static constexpr std::size_t kSectorBytes = 65536;  // smallest erasable unit
//     static constexpr std::size_t kSectors = 2;
//     bool read(std::size_t at, volcomp::Span<std::uint8_t> out);
//     bool write(std::size_t at, volcomp::Span<const std::uint8_t> bytes);  // erased bytes only
//     bool erase(std::size_t sector);                                       // every byte 0xFF
//   };
//
// Addresses count from 0 across all sectors. Each returns false when the hardware reports a
// failure; what was being written or erased then holds anything. Power may fail at any byte.

#include <cstddef>
#include <type_traits>
#include <utility>

#include "comp/span.hpp"

namespace volcomp::hal {

template <class Blocks, class = void>
struct IsBlockDevice : std::false_type {};

template <class Blocks>
struct IsBlockDevice<
    Blocks,
    std::void_t<
        decltype(std::size_t{Blocks::kSectorBytes}), decltype(std::size_t{Blocks::kSectors}),
        decltype(bool(std::declval<Blocks&>().read(std::size_t{}, Span<std::uint8_t>{}))),
        decltype(bool(std::declval<Blocks&>().write(std::size_t{}, Span<const std::uint8_t>{}))),
        decltype(bool(std::declval<Blocks&>().erase(std::size_t{})))>> : std::true_type {};

}  // namespace volcomp::hal
