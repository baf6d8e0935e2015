#pragma once
// The values behind the object dictionary of the compensation node, with their defaults, and the
// table that describes them: objects.def (firmware/volcomp.eds says the same to configuration
// tools).

#include <array>
#include <cstdint>
#include <type_traits>

#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/object_lines.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/node/node_features.hpp"
#include "firmware/node/probe/probe_objects.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"
#include "firmware/node/tables/node_compensator.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"
#include "firmware/node/ways.hpp"

namespace volcomp::node {

inline constexpr std::uint32_t kProductCode = 0x564F4C43;  // 1018h:02: "VOLC"

template <class T>
using PerAxis = std::array<T, kNodeAxes>;

// 2111h: what to do with the staged image.
enum class TableCommand : std::uint8_t {
  none = 0,
  validate = 1,    // check it: 2112h:02 says ok or why not
  arm = 2,         // fold it into the spare half of the double buffer
  activate = 3,    // ramp it in
  deactivate = 4,  // ramp to zero and stay there
  discard = 5,     // forget the staged image
};

inline constexpr std::size_t kMostReasonText = 160;  // bytes of 2112h:06

// 2112h:01.
enum class TableState : std::uint8_t {
#define TABLE_STATE(number, name, words) name = (number),
#include "firmware/node/states.def"
};

// 2600h:01.
enum class NodeState : std::uint8_t {
#define NODE_STATE(number, name, title, words) name = (number),
#include "firmware/node/states.def"
};

struct NodeObjects {
  canopen::CommunicationObjects communication{};
#define NODE OBJECT_MEMBER
#include "firmware/node/objects.def"
  PerAxis<std::array<std::uint16_t, kStatusBits>> began{};  // 2610h… how often each bit began

  std::conditional_t<kProbes, ProbeObjects, NoProbeObjects> probe{};
  std::conditional_t<kWatchesStrokes, StrokeObjects, NoStrokeObjects> stroke{};
  std::conditional_t<kFollowsTemperature, ThermalObjects, NoThermalObjects> thermal{};
};

// With the defaults of objects.def. A function, because the code for NodeObjects{} would otherwise
// be in flash once for every place where it stands.
[[nodiscard]] NodeObjects default_objects();

[[nodiscard]] canopen::Dictionary node_dictionary();
// The same for tools; images of devices leave it out.
[[nodiscard]] Span<const canopen::NamedEntry> named_node_dictionary();

// Numbers of the PDOs, from 0.
// From the drives: targets, actual values, held offsets, latches, edge counters (off in a node that
// does not probe). From the controller: what it grinds, how warm the axes are.
inline constexpr std::size_t kProcessStatePdo = 5 * kNodeAxes;
inline constexpr std::size_t kTemperaturePdo = kProcessStatePdo + 1;  // in every node that has it
inline constexpr std::size_t kReceivePdos =
    kFollowsTemperature ? kTemperaturePdo + 1 : kProcessStatePdo + (kWatchesStrokes ? 1 : 0);
// Those that a cycle is computed from: all but the temperatures.
inline constexpr std::size_t kCycleReceivePdos = kProcessStatePdo + (kWatchesStrokes ? 1 : 0);
// Offsets, node status, the latest point: number and verdict, X and Y, Z and uncertainty.
inline constexpr std::size_t kStatusPdo = kNodeAxes;
inline constexpr std::size_t kFirstPointPdo = kNodeAxes + 1;
inline constexpr std::size_t kPointPdos = 3;
inline constexpr std::size_t kTransmitPdos = kFirstPointPdo + (kProbes ? kPointPdos : 0);

// RPDOs with the offsets that the drives hold, one per axis.
inline constexpr std::size_t kFirstHeldPdo = 2 * kNodeAxes;
// Those with what the drives latched.
inline constexpr std::size_t kFirstLatchPdo = 3 * kNodeAxes;

// Default parameters of the PDOs for the drives of 2010h; those of absent drives are invalid, and
// those of held offsets where drives do not report (2207h) or take none (2034h).
[[nodiscard]] canopen::PdoParameters default_receive_pdo(std::size_t number,
                                                         const NodeObjects& objects);
[[nodiscard]] canopen::PdoParameters default_transmit_pdo(std::size_t number,
                                                          const NodeObjects& objects,
                                                          std::uint8_t node_id);
// The transmit PDO that carries the offset of an axis. What the controller adds goes to it in
// pairs: both are in that of the first of the pair.
[[nodiscard]] std::size_t offset_pdo(const NodeObjects& objects, std::size_t axis);

}  // namespace volcomp::node
