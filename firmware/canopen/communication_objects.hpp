#pragma once
// The communication profile area every device has (CiA 301, section 7.5.2), PDO parameters apart:
// those live in the PdoTable.

#include <array>
#include <cstddef>

#include "firmware/canopen/named_entry.hpp"

namespace volcomp::canopen {

inline constexpr std::size_t kErrorHistory = 8;
inline constexpr std::size_t kHeartbeatConsumers = 8;

struct Identity {
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::uint32_t revision = 0;
  std::uint32_t serial = 0;
};

// When the configuration tool last wrote: days and milliseconds since 1 January 1984.
struct ConfigurationStamp {
  std::uint32_t date = 0;
  std::uint32_t time = 0;
};

struct CommunicationObjects {
  std::uint32_t device_type = 0;                             // 1000h
  std::uint8_t error_register = 0;                           // 1001h
  std::uint8_t error_count = 0;                              // 1003h:00
  std::array<std::uint32_t, kErrorHistory> error_history{};  // 1003h, newest first
  std::uint32_t sync_cob_id = 0x80;                          // 1005h; bit 30: produces SYNC
  std::uint32_t cycle_period_us = 0;                         // 1006h
  std::uint32_t sync_window_us = 0;                          // 1007h; 0: not used
  std::array<char, 24> device_name{};                        // 1008h
  std::array<char, 8> hardware_version{};                    // 1009h
  std::array<char, 8> software_version{};                    // 100Ah
  std::uint32_t emergency_cob_id = 0x80;                     // 1014h; node id added at power-on
  std::uint16_t emergency_inhibit_100us = 0;                 // 1015h
  std::array<std::uint32_t, kHeartbeatConsumers> consumer_heartbeat{};  // 1016h: node << 16 | ms
  std::uint16_t producer_heartbeat_ms = 0;                              // 1017h
  Identity identity{};                                                  // 1018h
  std::uint8_t sync_counter_overflow = 0;                 // 1019h; 0: SYNC carries no counter
  ConfigurationStamp configuration_stamp{};               // 1020h date, time
  std::uint8_t error_behaviour = 0;                       // 1029h:01
  std::array<std::uint32_t, 2> sdo_cob_id{0x600, 0x580};  // 1200h; node id added at power-on
};

// 1029h: what a communication error does to an operational device.
enum class ErrorBehaviour : std::uint8_t { to_pre_operational = 0, no_change = 1, to_stopped = 2 };

#define VOLCOMP_AT(member) static_cast<std::uint16_t>(offsetof(CommunicationObjects, member))

// For a struct of values that begins with its CommunicationObjects.
inline constexpr std::array<NamedEntry, 23> kCommunicationEntries{{
    {0x1000, 0, 0, DataType::unsigned32, Access::constant, kPlain, VOLCOMP_AT(device_type), 0,
     "Device type"},
    {0x1001, 0, 0, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(error_register), 0,
     "Error register"},
    {0x1003, 0, 0, DataType::unsigned8, Access::read_write, kPlain, VOLCOMP_AT(error_count), 0,
     "Number of errors"},
    {0x1003, 1, kErrorHistory, DataType::unsigned32, Access::read_only, kPlain,
     VOLCOMP_AT(error_history), 0, "Standard error field"},
    {0x1005, 0, 0, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(sync_cob_id), 0,
     "COB-ID SYNC"},
    {0x1006, 0, 0, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(cycle_period_us),
     0, "Communication cycle period", 0, 10'000'000},
    {0x1007, 0, 0, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(sync_window_us), 0,
     "Synchronous window length", 0, 10'000'000},
    {0x1008, 0, 0, DataType::visible_string, Access::constant, kPlain, VOLCOMP_AT(device_name), 24,
     "Manufacturer device name"},
    {0x1009, 0, 0, DataType::visible_string, Access::constant, kPlain, VOLCOMP_AT(hardware_version),
     8, "Manufacturer hardware version"},
    {0x100A, 0, 0, DataType::visible_string, Access::constant, kPlain, VOLCOMP_AT(software_version),
     8, "Manufacturer software version"},
    {0x1014, 0, 0, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(emergency_cob_id), 0,
     "COB-ID EMCY"},
    {0x1015, 0, 0, DataType::unsigned16, Access::read_write, kStored,
     VOLCOMP_AT(emergency_inhibit_100us), 0, "Inhibit time EMCY"},
    {0x1016, 1, kHeartbeatConsumers, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(consumer_heartbeat), 0, "Consumer heartbeat time", 0, 0xFFFFFF},
    {0x1017, 0, 0, DataType::unsigned16, Access::read_write, kStored,
     VOLCOMP_AT(producer_heartbeat_ms), 0, "Producer heartbeat time"},
    {0x1018, 1, 1, DataType::unsigned32, Access::constant, kPlain, VOLCOMP_AT(identity.vendor), 0,
     "Vendor-ID"},
    {0x1018, 2, 2, DataType::unsigned32, Access::constant, kPlain, VOLCOMP_AT(identity.product), 0,
     "Product code"},
    {0x1018, 3, 3, DataType::unsigned32, Access::constant, kPlain, VOLCOMP_AT(identity.revision), 0,
     "Revision number"},
    {0x1018, 4, 4, DataType::unsigned32, Access::constant, kPlain, VOLCOMP_AT(identity.serial), 0,
     "Serial number"},
    {0x1019, 0, 0, DataType::unsigned8, Access::read_write, kStored,
     VOLCOMP_AT(sync_counter_overflow), 0, "Synchronous counter overflow value", 0, 240},
    {0x1020, 1, 1, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(configuration_stamp.date), 0, "Configuration date"},
    {0x1020, 2, 2, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(configuration_stamp.time), 0, "Configuration time"},
    {0x1029, 1, 1, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(error_behaviour), 0,
     "Communication error", 0, 2},
    {0x1200, 1, 2, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(sdo_cob_id), 0,
     "COB-ID client to server, server to client"},
}};

#undef VOLCOMP_AT

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
