#pragma once
// The communication profile area every device has (CiA 301, section 7.5.2), PDO parameters apart:
// those live in the PdoTable.

#include <array>
#include <cstddef>

#include "firmware/canopen/object_lines.hpp"

namespace volcomp::canopen {

inline constexpr std::size_t kErrorHistory = 8;
inline constexpr std::size_t kHeartbeatConsumers = 8;

// The node id is added at power-on.
inline constexpr std::array<std::uint32_t, 2> kSdoCobIds{0x600, 0x580};

struct CommunicationObjects {
#define COMMON OBJECT_MEMBER
#include "firmware/canopen/communication.def"
};

// By name, for who reads and writes them: object::cycle_period_us.
namespace object {
#define COMMON OBJECT_HANDLE
#include "firmware/canopen/communication.def"
}  // namespace object

// 1029h: what a communication error does to an operational device.
enum class ErrorBehaviour : std::uint8_t { to_pre_operational = 0, no_change = 1, to_stopped = 2 };

// For a struct of values that begins with its CommunicationObjects.
inline constexpr std::array kCommunicationEntries{
#define COMMON(index, sub, count, type, member, use, value, range, name)                           \
  object_lines::row<object_lines::type>(index, sub, count, offsetof(CommunicationObjects, member), \
                                        object_lines::use, object_lines::range, name),
#include "firmware/canopen/communication.def"
};

// A table made of the communication entries and an application's own, in the order of a dictionary.
template <std::size_t Own>
constexpr std::array<NamedEntry, kCommunicationEntries.size() + Own> with_communication(
    const std::array<NamedEntry, Own>& own) {
  std::array<NamedEntry, kCommunicationEntries.size() + Own> all{};
  std::size_t mine = 0;
  std::size_t common = 0;
  for (NamedEntry& entry : all) {
    const bool take_mine = common == kCommunicationEntries.size() ||
                           (mine < Own && own[mine].index < kCommunicationEntries[common].index);
    entry = take_mine ? own[mine] : kCommunicationEntries[common];
    ++(take_mine ? mine : common);
  }
  return all;
}

}  // namespace volcomp::canopen
