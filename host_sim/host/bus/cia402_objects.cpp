#include "host_sim/host/bus/cia402_objects.hpp"

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

using canopen::Access;
using canopen::DataType;
using canopen::kPlain;
using canopen::kReceive;
using canopen::kTransmit;
using canopen::mapped;
using canopen::NamedEntry;

constexpr std::uint8_t kBoth = kReceive | kTransmit;

#define VOLCOMP_AT(member) static_cast<std::uint16_t>(offsetof(Cia402Objects, member))

// Scaling and units are read-only: they describe the mechanics, writing cannot change them.
constexpr std::array<NamedEntry, 40> kDriveEntries{{
    {0x6007, 0, 0, DataType::integer16, Access::read_write, kPlain, VOLCOMP_AT(abort_connection), 0,
     "Abort connection option code", 0, 3},
    {0x603F, 0, 0, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(error_code), 0,
     "Error code"},
    {0x6040, 0, 0, DataType::unsigned16, Access::read_write, kReceive, VOLCOMP_AT(controlword), 0,
     "Controlword"},
    {0x6041, 0, 0, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(statusword), 0,
     "Statusword"},
    {0x605A, 0, 0, DataType::integer16, Access::read_write, kPlain, VOLCOMP_AT(quick_stop_option),
     0, "Quick stop option code"},
    {0x605E, 0, 0, DataType::integer16, Access::read_write, kPlain, VOLCOMP_AT(fault_option), 0,
     "Fault reaction option code"},
    {0x6060, 0, 0, DataType::integer8, Access::read_write, kReceive, VOLCOMP_AT(mode), 0,
     "Modes of operation"},
    {0x6061, 0, 0, DataType::integer8, Access::read_only, kTransmit, VOLCOMP_AT(mode_display), 0,
     "Modes of operation display"},
    {0x6062, 0, 0, DataType::integer32, Access::read_only, kTransmit, VOLCOMP_AT(demand), 0,
     "Position demand value"},
    {0x6064, 0, 0, DataType::integer32, Access::read_only, kTransmit, VOLCOMP_AT(actual), 0,
     "Position actual value"},
    {0x6065, 0, 0, DataType::unsigned32, Access::read_write, kReceive, VOLCOMP_AT(following_window),
     0, "Following error window"},
    {0x607A, 0, 0, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(target), 0,
     "Target position"},
    {0x607C, 0, 0, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(home_offset), 0,
     "Home offset"},
    {0x607D, 1, 2, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(software_limit), 0,
     "Software position limit"},
    {0x6085, 0, 0, DataType::unsigned32, Access::read_write, kReceive,
     VOLCOMP_AT(quick_stop_deceleration), 0, "Quick stop deceleration", 1, UINT32_MAX},
    {0x608F, 1, 2, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(encoder_resolution),
     0, "Position encoder resolution"},
    {0x6091, 1, 2, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(gear), 0,
     "Gear ratio"},
    {0x6092, 1, 2, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(feed), 0,
     "Feed constant"},
    {0x6098, 0, 0, DataType::integer8, Access::read_write, kReceive, VOLCOMP_AT(homing_method), 0,
     "Homing method", kHomeHere, kHomeHere},
    {0x60A8, 0, 0, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(position_unit), 0,
     "SI unit position"},
    {0x60B0, 0, 0, DataType::integer32, Access::read_write, kBoth, VOLCOMP_AT(offset), 0,
     "Position offset"},
    {0x60B8, 0, 0, DataType::unsigned16, Access::read_write, kReceive, VOLCOMP_AT(probe.function),
     0, "Touch probe function"},
    {0x60B9, 0, 0, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(probe.status), 0,
     "Touch probe status"},
    {0x60BA, 0, 0, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_1.position), 0, "Touch probe 1 positive edge"},
    {0x60BB, 0, 0, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_1.position), 0, "Touch probe 1 negative edge"},
    {0x60BC, 0, 0, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_2.position), 0, "Touch probe 2 positive edge"},
    {0x60BD, 0, 0, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_2.position), 0, "Touch probe 2 negative edge"},
    {0x60C2, 1, 1, DataType::unsigned8, Access::read_write, kPlain, VOLCOMP_AT(cycle_value), 0,
     "Interpolation time period value"},
    {0x60C2, 2, 2, DataType::integer8, Access::read_write, kPlain, VOLCOMP_AT(cycle_exponent), 0,
     "Interpolation time index"},
    {0x60D0, 1, 2, DataType::integer16, Access::read_write, kReceive, VOLCOMP_AT(probe.source), 0,
     "Touch probe source"},
    {0x60D1, 0, 0, DataType::unsigned32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_1.time_ns), 0, "Touch probe time stamp 1 positive value"},
    {0x60D2, 0, 0, DataType::unsigned32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_1.time_ns), 0, "Touch probe time stamp 1 negative value"},
    {0x60D3, 0, 0, DataType::unsigned32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_2.time_ns), 0, "Touch probe time stamp 2 positive value"},
    {0x60D4, 0, 0, DataType::unsigned32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_2.time_ns), 0, "Touch probe time stamp 2 negative value"},
    {0x60D5, 0, 0, DataType::unsigned16, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_1.edge_count), 0, "Touch probe 1 positive edge counter"},
    {0x60D6, 0, 0, DataType::unsigned16, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_1.edge_count), 0, "Touch probe 1 negative edge counter"},
    {0x60D7, 0, 0, DataType::unsigned16, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.positive_2.edge_count), 0, "Touch probe 2 positive edge counter"},
    {0x60D8, 0, 0, DataType::unsigned16, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.negative_2.edge_count), 0, "Touch probe 2 negative edge counter"},
    {0x60F4, 0, 0, DataType::integer32, Access::read_only, kTransmit, VOLCOMP_AT(following_error),
     0, "Following error actual value"},
    {0x6502, 0, 0, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(supported_modes), 0,
     "Supported drive modes"},
}};

#undef VOLCOMP_AT

constexpr auto kNamed = canopen::with_communication(kDriveEntries);

struct Layout {
  std::uint16_t cob_id;
  std::uint8_t type;
  std::uint8_t count;
  std::array<std::uint32_t, 3> mapping;
};

constexpr std::uint8_t kEverySync = 1;
constexpr std::uint8_t kNextSync = 0;

constexpr std::array<Layout, kReceivePdos> kReceiveLayout{{
    {0x200, kEverySync, 2, {mapped(0x6040, 0, 16), mapped(0x607A, 0, 32)}},
    {0x300, kEverySync, 1, {mapped(0x60B0, 0, 32)}},
}};
constexpr std::array<Layout, kTransmitPdos> kTransmitLayout{{
    {0x180, kEverySync, 3, {mapped(0x6064, 0, 32), mapped(0x6041, 0, 16), mapped(0x60B9, 0, 16)}},
    {0x280, kNextSync, 2, {mapped(0x60BA, 0, 32), mapped(0x60D1, 0, 32)}},
    {0x380, canopen::kEventType, 2, {mapped(0x60D5, 0, 16), mapped(0x60F4, 0, 32)}},
    {0x480, kEverySync, 1, {mapped(0x60B0, 0, 32)}},
}};

template <std::size_t N>
std::array<canopen::PdoParameters, N> parameters(const std::array<Layout, N>& layouts,
                                                 std::uint32_t id_and_flags) {
  std::array<canopen::PdoParameters, N> all{};
  for (std::size_t i = 0; i < N; ++i) {
    all[i].cob_id = layouts[i].cob_id + id_and_flags;
    all[i].type = layouts[i].type;
    all[i].count = layouts[i].count;
    for (std::size_t k = 0; k < layouts[i].mapping.size(); ++k)
      all[i].mapping[k] = layouts[i].mapping[k];
  }
  return all;
}

}  // namespace

canopen::Dictionary cia402_dictionary() { return canopen::DictionaryOf<kNamed>::value; }

Span<const NamedEntry> named_cia402_dictionary() { return kNamed; }

std::array<canopen::PdoParameters, kReceivePdos> cia402_receive_pdos(std::uint8_t node_id) {
  return parameters(kReceiveLayout, node_id);
}

std::array<canopen::PdoParameters, kTransmitPdos> cia402_transmit_pdos(std::uint8_t node_id) {
  return parameters(kTransmitLayout, canopen::kPdoNoRtr | node_id);
}

}  // namespace volcomp::host
