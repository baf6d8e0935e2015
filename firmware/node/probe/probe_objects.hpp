#pragma once
// The values behind 2300h (probe and feature) and 2400h (points), with their defaults. Lengths in
// nm, angles in rad.

#include <array>
#include <cstdint>

#include "comp/probe/lobing.hpp"
#include "comp/probe/probe_rule.hpp"
#include "firmware/canopen/object_lines.hpp"
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

inline constexpr std::int32_t kNoDistance = INT32_MIN;  // 2401h:0C
inline constexpr std::uint8_t kNotJudged = 255;         // verdict of a point that has no flank

// 2303h: rotation by rows, then the origin.
constexpr std::array<double, 12> part_on_holder() {
  std::array<double, 12> part{};
  part[0] = part[4] = part[8] = 1.0;
  return part;
}

// 2313h: the flank that is touched next. Taken over by writing 2310h:01.
struct FlankObjects {
#define FLANK OBJECT_MEMBER
#include "firmware/node/objects.def"
};

// 2304h: radius, tool length, correlation of the two, repeatability, tables, normal, probe delay
// (ns). 2401h:0C…0F describe the latest point on an announced flank.
struct ProbeObjects {
#define PROBE OBJECT_MEMBER
#include "firmware/node/objects.def"
  FlankObjects flank{};
};

// Stands in for the objects in a node that does not probe.
struct NoProbeObjects {};

}  // namespace volcomp::node
