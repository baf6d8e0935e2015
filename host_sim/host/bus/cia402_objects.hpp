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

struct Ratio {
  std::uint32_t numerator = 1;
  std::uint32_t denominator = 1;
};

// What one edge of one probe leaves behind.
struct TouchProbeLatch {
  std::int32_t position = 0;     // 60BAh…60BDh
  std::uint32_t time_ns = 0;     // 60D1h…60D4h: since the SYNC before it
  std::uint16_t edge_count = 0;  // 60D5h…60D8h: latched edges since power-on, wraps
};

struct TouchProbeObjects {
  std::uint16_t function = 0;                // 60B8h
  std::uint16_t status = 0;                  // 60B9h
  std::array<std::int16_t, 2> source{1, 2};  // 60D0h: the input each probe is wired to
  TouchProbeLatch positive_1;
  TouchProbeLatch negative_1;
  TouchProbeLatch positive_2;
  TouchProbeLatch negative_2;
};

struct Cia402Objects {
  canopen::CommunicationObjects communication{};
  std::int16_t abort_connection = 3;                   // 6007h
  std::uint16_t error_code = 0;                        // 603Fh: of the last fault
  std::uint16_t controlword = 0;                       // 6040h
  std::uint16_t statusword = 0;                        // 6041h
  std::int16_t quick_stop_option = kQuickStopThenOff;  // 605Ah
  std::int16_t fault_option = kFaultBrake;             // 605Eh
  std::int8_t mode = 8;                                // 6060h
  std::int8_t mode_display = 8;                        // 6061h
  std::int32_t demand = 0;                             // 6062h
  std::int32_t actual = 0;                             // 6064h
  std::uint32_t following_window = 0;                  // 6065h
  std::int32_t target = 0;                             // 607Ah
  std::int32_t home_offset = 0;  // 607Ch: reading of the home position; until written, the reading
  std::array<std::int32_t, 2> software_limit{};  // 607Dh: of the demand, linear axes only
  std::uint32_t quick_stop_deceleration = 0;     // 6085h: position units/s²
  Ratio encoder_resolution;                      // 608Fh: increments, motor revolutions
  Ratio gear;                                    // 6091h: motor, shaft revolutions
  Ratio feed;                                    // 6092h: position units, shaft revolutions
  std::int8_t homing_method = kHomeHere;         // 6098h
  std::uint32_t position_unit = kNanometre;      // 60A8h
  std::int32_t offset = 0;                       // 60B0h
  TouchProbeObjects probe;                       // 60B8h…60BDh, 60D0h…60D8h
  std::uint8_t cycle_value = 1;                  // 60C2h:01
  std::int8_t cycle_exponent = -3;               // 60C2h:02; period = value · 10^exponent s
  std::int32_t following_error = 0;              // 60F4h
  std::uint32_t supported_modes = 0x00A0;        // 6502h: homing, cyclic synchronous position
};

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
