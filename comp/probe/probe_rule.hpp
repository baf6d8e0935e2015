#pragma once
// Which settings of a probe and which normals are accepted: one rule for the node (2300h) and for C
// (volcomp.h).

#include "comp/core/status.hpp"
#include "comp/probe/probe_corrector.hpp"

namespace volcomp {

// From contact to edge and from edge to latch, each from 0 to this: radio probes take 10 ms and
// more.
inline constexpr std::uint32_t kMaxProbeDelay_ns = 50'000'000;
inline constexpr double kMaxProbeDelay_s = kMaxProbeDelay_ns / 1e9;

enum class ProbeSetting : std::uint8_t {
  none,
  uncertainty,
  correlation,
  radius,
  rotation,
  translation,
  delay,
  latch_delay,
};

struct ProbeRefusal {
  Reason reason = Reason::ok;
  ProbeSetting setting = ProbeSetting::none;  // that is refused
};

// ok; not_finite; not_a_rotation; bad_setting for a number beyond these limits and those of
// probe_corrector.hpp, for a negative radius, delay or uncertainty, and for a correlation beyond
// ±1.
[[nodiscard]] ProbeRefusal check_probe_settings(const ProbeSettings& settings);

// Of a feature: a unit vector, or 0 for an unknown direction. ok, not_finite or bad_setting.
[[nodiscard]] Reason check_normal(const Vec3& normal);

}  // namespace volcomp
