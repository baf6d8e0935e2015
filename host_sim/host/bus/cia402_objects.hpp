#pragma once
// The object dictionary of a servo drive: the application area of CiA 402-2 that a cyclic
// synchronous position drive with homing and touch probe has, and its default PDOs.

#include <array>
#include <cstdint>

#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/canopen/pdo.hpp"

namespace volcomp::host {

// CiA 402-2, error code "following error".
inline constexpr auto kFollowingErrorCode = static_cast<canopen::ErrorCode>(0x8611);
// The same for 6007h = 1; the EMCY of the lost heartbeat itself is 8130h.
inline constexpr auto kCommunicationErrorCode = static_cast<canopen::ErrorCode>(0x8100);

// 6060h, 6061h.
enum class OperationMode : std::int8_t { none = 0, homing = 6, cyclic_position = 8 };

// 6007h: what the drive does when it is left alone.
enum class AbortConnection : std::int16_t { nothing = 0, fault = 1, disable_voltage = 2, stop = 3 };

// 605Ah: brake with 6085h, then switch on disabled (2) or stay in quick stop active (6).
inline constexpr std::int16_t kQuickStopThenOff = 2;
inline constexpr std::int16_t kQuickStopThenStay = 6;

// 605Eh: power off at once (0), or brake with 6085h first (2).
inline constexpr std::int16_t kFaultOff = 0;
inline constexpr std::int16_t kFaultBrake = 2;

inline constexpr std::int8_t kHomeHere = 37;  // 6098h: homing on current position
inline constexpr std::uint32_t kNoFollowingWindow = UINT32_MAX;  // 6065h: not supervised

// 60A8h, prefix in the highest byte, unit code of CiA 303-2 in the next.
inline constexpr std::uint32_t kNanometre = 0xF701'0000;  // 10⁻⁹, metre
inline constexpr std::uint32_t kIncrement = 0x00B5'0000;  // 10⁰, increment; 6092h: 2³¹ in a turn

// 60D0h: the input each probe is wired to.
inline constexpr std::array<std::int16_t, 2> kProbeInputs{1, 2};

// What one edge of one probe leaves behind.
struct TouchProbeLatch {
  std::int32_t position = 0;     // 60BAh…60BDh
  std::uint32_t time_ns = 0;     // 60D1h…60D4h: since the SYNC before it
  std::uint16_t edge_count = 0;  // 60D5h…60D8h: latched edges since power-on, wraps
};

struct TouchProbeObjects {
#define TOUCH OBJECT_MEMBER
#include "host_sim/host/bus/cia402.def"
  TouchProbeLatch positive_1;
  TouchProbeLatch negative_1;
  TouchProbeLatch positive_2;
  TouchProbeLatch negative_2;
};

// Room for the objects that a drive has beyond these: they hold what is written, nothing acts on
// it.
inline constexpr std::size_t kForeignBytes = 2048;

struct Cia402Objects {
  canopen::CommunicationObjects communication{};
#define DRIVE OBJECT_MEMBER
#include "host_sim/host/bus/cia402.def"
  TouchProbeObjects probe;
  std::array<std::uint8_t, kForeignBytes> foreign{};
};

// By name, for who reads and writes them: cia402::controlword, cia402::positive_1_position.
namespace cia402 {
#define DRIVE OBJECT_HANDLE
#define TOUCH OBJECT_HANDLE
#define EDGE(index, type, edge, member, name) \
  OBJECT_HANDLE(index, 0, 1, type, edge##_##member, sent, , any, name)
#include "host_sim/host/bus/cia402.def"
}  // namespace cia402

[[nodiscard]] canopen::Dictionary cia402_dictionary();
[[nodiscard]] Span<const canopen::NamedEntry> named_cia402_dictionary();

// Where a TPDO stands in cia402_transmit_pdos().
inline constexpr std::size_t kActualPdo = 0;  // 180h + n: 6064h, 6041h, 60B9h
inline constexpr std::size_t kLatchPdo = 1;   // 280h + n: 60BAh, 60D1h; type 0
inline constexpr std::size_t kEdgePdo = 2;    // 380h + n: 60D5h, 60F4h; type 254
inline constexpr std::size_t kOffsetPdo = 3;  // 480h + n: 60B0h
inline constexpr std::size_t kTransmitPdos = 4;
inline constexpr std::size_t kReceivePdos = 2;  // 200h + n: 6040h, 607Ah; 300h + n: 60B0h

[[nodiscard]] std::array<canopen::PdoParameters, kReceivePdos> cia402_receive_pdos(
    std::uint8_t node_id);
[[nodiscard]] std::array<canopen::PdoParameters, kTransmitPdos> cia402_transmit_pdos(
    std::uint8_t node_id);

}  // namespace volcomp::host
