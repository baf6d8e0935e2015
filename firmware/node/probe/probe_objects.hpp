#pragma once
// The values behind 2300h (probe and feature) and 2400h (points), with their defaults. Lengths in
// nm, angles in rad.

#include <array>
#include <cstdint>

#include "comp/probe/lobing.hpp"
#include "firmware/node/tables/node_compensator.hpp"

namespace volcomp::node {

// 2300h:01.
enum class ProbeCommand : std::uint8_t {
  off = 0,  // edges are not looked at
  on = 1,   // the settings of 2300h…2306h are taken over; edges become points
};

// 2312h, as FaceGear has them: teeth of shaper and gear, module (mm), pressure angle (rad), addenda
// of gear and shaper (modules), radii inside and outside (mm), amount, begin and length of the tip
// relief (mm). 0: the default of FaceGear.
using GearNumbers = std::array<double, 11>;

// 2313h: the flank that is touched next. Taken over by writing 2310h:01.
struct FlankObjects {
  std::uint32_t gear = 0;       // :01 as 2311h:01, or 0: no flank
  std::int8_t side = 0;         // :02 ±1, as FaceFlank
  std::uint16_t slot = 0;       // :03 from 0
  std::uint8_t row = 0;         // :04 of the measuring grid, from 0: copied to the point
  std::uint8_t column = 0;      // :05
  std::uint32_t radius_nm = 0;  // :06 of the ball
  std::uint32_t gate_nm = 0;    // :07 as FaceProbing
};

inline constexpr std::int32_t kNoDistance = INT32_MIN;  // 2401h:0C
inline constexpr std::uint8_t kNotJudged = 255;         // verdict of a point that has no flank

struct ProbeObjects {
  std::uint8_t command = 0;        // 2300h:01 ProbeCommand
  std::uint32_t delay_ns = 0;      // 2300h:02 from contact to the edge at the drives
  std::uint32_t bounce_us = 1000;  // 2300h:03 no two touches are closer
  std::uint32_t skew_ns = 2000;    // 2300h:04 most between the edges of two axes
  std::uint8_t reason = 0;         // 2300h:05 Reason of the last refusal of the settings
  std::array<std::uint32_t, kNodeAxes> latch_delay_ns{};  // 2301h from the edge to the latch
  LobingTerms lobing{};                                   // 2302h effective radius of the ball
  std::array<double, 12> workpiece{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};  // 2303h R by rows, t
  // 2304h standard uncertainties: radius, tool length, correlation of the two, repeatability,
  // tables, normal, probe delay (ns)
  std::array<double, 7> uncertainty{};
  std::array<double, kNodeAxes> position_uncertainty{};        // 2305h nm or rad
  std::array<double, kNodeAxes> latch_delay_uncertainty_ns{};  // 2306h
  std::uint32_t feature = 0;                                   // 2310h:01; takes 02…04 over
  std::array<double, 3> normal{};     // 2310h:02…04 workpiece frame, or 0; unused with a flank
  std::uint8_t flank_reason = 0;      // 2310h:05 Reason of the last refusal of 2313h
  std::uint8_t flank_field = 0;       // 2310h:06 sub-index of 2313h it was refused for, or 0
  std::uint32_t gear = 0;             // 2311h:01 id of the gear in force, 0: none; takes 2312h over
  std::uint8_t gear_reason = 0;       // 2311h:02 Reason of the last refusal of 2312h
  std::array<char, 16> gear_field{};  // 2311h:03 field of FaceGear it was refused for
  GearNumbers gear_number{};          // 2312h
  FlankObjects flank{};               // 2313h

  std::uint16_t waiting = 0;      // 2400h:01 points not yet released
  std::uint32_t lost = 0;         // 2400h:02 points that found no room
  std::uint32_t touches = 0;      // 2400h:03 edges since start, rejected ones included
  std::uint32_t rejected = 0;     // 2400h:04
  std::uint32_t sequence = 0;     // 2401h:01 of the latest point
  std::uint8_t verdict = 0;       // 2401h:02 TouchVerdict
  std::uint8_t axis = 0;          // 2401h:03 the verdict is about, 1…; 0: none in particular
  std::uint16_t feature_low = 0;  // 2401h:04 low half of its feature
  std::array<std::int32_t, 3> workpiece_nm{};  // 2401h:05…07, saturated
  std::uint32_t uncertainty_nm = 0;            // 2401h:08 largest standard uncertainty, rounded up
  std::array<std::int64_t, 3> machine_nm{};    // 2401h:09…11
  // The four below describe the latest point on an announced flank.
  std::int32_t distance_nm = kNoDistance;   // 2401h:0C λ, rounded
  std::uint8_t flank_verdict = kNotJudged;  // 2401h:0D Reason of judge_touch()
  std::uint8_t foot = kNotJudged;           // 2401h:0E Reason of its foot
  std::uint32_t judged = 0;                 // 2401h:0F its number
  std::uint32_t release = 0;                // 2411h
};

}  // namespace volcomp::node
