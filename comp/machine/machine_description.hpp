#pragma once
// A machine as data: bodies, joints, functional point, axes that take offsets. A literal type, so
// that a machine can be `constexpr`; checked by MachineChain::build.

#include <array>
#include <cstdint>

#include "comp/machine/joint.hpp"

namespace volcomp {

inline constexpr std::size_t kMaxAxes = 8;
inline constexpr std::size_t kMaxBodies = 16;
inline constexpr std::size_t kMaxCorrecting = 3;
inline constexpr std::size_t kMaxOrienting = 2;

// Body K hangs on body `lower` < K by its joint; the root hangs on 0 (Huston's lower-body array, as
// in the paper of docs/papers/internal-helical.md).
struct Body {
  std::uint8_t lower = 0;
  Joint joint{};
  std::array<double, 6> constant_error{};  // fixed bodies only, internal convention, mm and rad
};

struct MachineDescription {
  std::array<Body, kMaxBodies> body{};
  std::uint8_t body_count = 0;
  std::uint8_t work_body = 0;  // 1-based, as all body numbers
  std::uint8_t tool_body = 0;
  std::array<double, 3> tool_point{};                     // functional point in the tool frame, mm
  std::array<std::uint8_t, kMaxCorrecting> correcting{};  // NC axes that take offsets
  std::uint8_t correcting_count = 0;
  std::array<std::uint8_t, kMaxOrienting> orienting{};  // rotary ones that keep the tool's axis
  std::uint8_t orienting_count = 0;                     // in its direction; none of `correcting`
};

}  // namespace volcomp
