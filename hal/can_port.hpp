#pragma once
// A CAN controller as the node sees it: classical frames with 11-bit identifiers. Bound at compile
// time. A board writes one class with these two members:
//
//   struct MyCanPort {
//     bool send(const volcomp::hal::CanFrame& frame);  // false: no room, nothing taken; try later
//     bool receive(volcomp::hal::CanFrame& frame);     // false: nothing there
//   };
//
// Neither blocks. A frame handed to send() is sent or, after bus-off, lost. Frames with one
// identifier leave in the order they were handed over; a lower identifier may overtake.

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace volcomp::hal {

inline constexpr std::uint16_t kMaxCanId = 0x7FF;

struct CanFrame {
  std::uint16_t id = 0;                // 0…0x7FF
  std::uint8_t size = 0;               // bytes, 0…8
  std::array<std::uint8_t, 8> data{};  // zero beyond size
};

constexpr bool operator==(const CanFrame& a, const CanFrame& b) {
  if (a.id != b.id || a.size != b.size) return false;
  for (std::size_t i = 0; i < a.size; ++i) {
    if (a.data[i] != b.data[i]) return false;
  }
  return true;
}
constexpr bool operator!=(const CanFrame& a, const CanFrame& b) { return !(a == b); }

// What error counting has made of a CAN controller (ISO 11898-1). Passive: more than 127 errors, it
// disturbs no other station any more; off: more than 255 while sending, it takes no part.
enum class CanBusState : std::uint8_t { stopped, active, warning, passive, off };

template <class Port, class = void>
struct IsCanPort : std::false_type {};

template <class Port>
struct IsCanPort<
    Port, std::void_t<decltype(bool(std::declval<Port&>().send(std::declval<CanFrame>()))),
                      decltype(bool(std::declval<Port&>().receive(std::declval<CanFrame&>())))>>
    : std::true_type {};

}  // namespace volcomp::hal
