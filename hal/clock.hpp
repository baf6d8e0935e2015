#pragma once
// Monotonic time. Bound at compile time; a board writes one class with one member:
//
//   struct MyClock {
//     std::uint64_t now_us() const;  // never goes back; any start
//   };

#include <cstdint>
#include <type_traits>
#include <utility>

namespace volcomp::hal {

template <class Clock, class = void>
struct IsClock : std::false_type {};

template <class Clock>
struct IsClock<Clock, std::void_t<decltype(std::uint64_t{std::declval<const Clock&>().now_us()})>>
    : std::true_type {};

}  // namespace volcomp::hal
