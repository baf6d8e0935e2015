#pragma once
// Restarts the processor when it is not fed. Bound at compile time. A board writes one class:
//
//   struct MyWatchdog {
//     void feed();                          // the full time again
//     std::uint32_t remaining_us() const;   // until the bite if it is not fed
//   };
//
// Once started it cannot be stopped by software. Both members are safe in an interrupt.

#include <cstdint>
#include <type_traits>
#include <utility>

namespace volcomp::hal {

template <class Watchdog, class = void>
struct IsWatchdog : std::false_type {};

template <class Watchdog>
struct IsWatchdog<
    Watchdog, std::void_t<decltype(std::declval<Watchdog&>().feed()),
                          decltype(std::uint32_t{std::declval<const Watchdog&>().remaining_us()})>>
    : std::true_type {};

}  // namespace volcomp::hal
