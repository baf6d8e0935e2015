#pragma once
// Keeps the tick interrupt out while the background works on what both share. Bound at compile
// time. A board writes one class:
//
//   struct MyCriticalSection {
//     void enter();  // the tick does not run until leave()
//     void leave();  // a tick that fell due meanwhile runs at once
//   };
//
// Called from the background only, never nested. A tick that falls due twice inside is lost once,
// so what runs inside has to be short against the period.

#include <type_traits>
#include <utility>

namespace volcomp::hal {

template <class Section, class = void>
struct IsCriticalSection : std::false_type {};

template <class Section>
struct IsCriticalSection<Section, std::void_t<decltype(std::declval<Section&>().enter()),
                                              decltype(std::declval<Section&>().leave())>>
    : std::true_type {};

}  // namespace volcomp::hal
