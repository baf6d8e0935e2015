#pragma once
// What a motion controller must offer to run the compensation integrated: a snapshot of its axes
// and a place for the offsets. Bound at compile time; no virtual call, no queue. A board writes one
// class with these two members:
//
//   struct MyAxisPort {
//     // all axes at one instant: position, valid, homed
//     void sample(volcomp::TickInput<N>& in) noexcept;
//
//     // added to the command of the next servo period
//     void apply(const volcomp::TickOutput<N>& out) noexcept;
//   };
//
// sample(): linear axes in nm, rotary axes in 2^-40 turn counted through; `valid` false when the
// value is lost, stale or not a number; `homed` false until referenced and enabled. Called from the
// servo interrupt, must not block.

#include <type_traits>
#include <utility>

#include "comp/tick/tick_types.hpp"

namespace volcomp::hal {

template <class Port, std::size_t Axes, class = void>
struct IsAxisPort : std::false_type {};

template <class Port, std::size_t Axes>
struct IsAxisPort<
    Port, Axes,
    std::void_t<decltype(std::declval<Port&>().sample(std::declval<TickInput<Axes>&>())),
                decltype(std::declval<Port&>().apply(std::declval<const TickOutput<Axes>&>()))>>
    : std::true_type {};

}  // namespace volcomp::hal
