#include "host_sim/host/bus/cia402_objects.hpp"

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

namespace lines = canopen::object_lines;
using canopen::NamedEntry;

constexpr std::array kDriveEntries{
#define ROW(index, sub, count, type, member, use, range, name)                            \
  lines::row<lines::type>(index, sub, count, offsetof(Cia402Objects, member), lines::use, \
                          lines::range, name),
#define DRIVE(index, sub, count, type, member, use, value, range, name) \
  ROW(index, sub, count, type, member, use, range, name)
#define TOUCH(index, sub, count, type, member, use, value, range, name) \
  ROW(index, sub, count, type, probe.member, use, range, name)
#define EDGE(index, type, edge, member, name) \
  ROW(index, 0, 1, type, probe.edge.member, sent, any, name)
#include "host_sim/host/bus/cia402.def"
#undef ROW
};

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
    {0x200, kEverySync, 2, {cia402::controlword.mapped(), cia402::target.mapped()}},
    {0x300, kEverySync, 1, {cia402::offset.mapped()}},
}};
constexpr std::array<Layout, kTransmitPdos> kTransmitLayout{{
    {0x180,
     kEverySync,
     3,
     {cia402::actual.mapped(), cia402::statusword.mapped(), cia402::status.mapped()}},
    {0x280,
     kNextSync,
     2,
     {cia402::positive_1_position.mapped(), cia402::positive_1_time_ns.mapped()}},
    {0x380,
     canopen::kEventType,
     2,
     {cia402::positive_1_edge_count.mapped(), cia402::following_error.mapped()}},
    {0x480, kEverySync, 1, {cia402::offset.mapped()}},
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
