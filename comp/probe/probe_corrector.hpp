#pragma once
// From latched axes to the point that was touched:
//
//   latch − delay · velocity → nominal chain + E → ball centre → − r(direction) · normal → point
//
// Everything is O(1) and bounded; no libm but one square root per coordinate. Positions and lengths
// in nm.

#include <cstdint>

#include "comp/machine/frame.hpp"
#include "comp/probe/lobing.hpp"
#include "comp/probe/nominal_chain.hpp"
#include "comp/tick/touch.hpp"

namespace volcomp {

// Largest values in settings and touches, so that 64 bits hold every point. The interfaces check
// them where they take settings and touches in: correct() has no time for that.
inline constexpr double kMaxBallRadius_nm = 2e7;  // r_c below 20 mm; each term
inline constexpr double kMaxPart_nm = 1e13;       // origin of the part, and every uncertainty
inline constexpr double kMaxContact_nm = 1e18;    // of one axis: latch and what it moved since

// Standard uncertainties of what goes into a point.
struct ProbeUncertainty {
  double radius = 0.0;         // of the effective radius, nm
  double tool_length = 0.0;    // of the tool point along its vector from the tool frame, nm
  double correlation = 0.0;    // of these two, −1…1: both come from one calibration
  double repeatability = 0.0;  // of the probe along the normal, nm
  double tables = 0.0;         // of the volumetric correction, per coordinate, nm
  double normal = 0.0;         // of the direction of the normal, rad
  double probe_delay_s = 0.0;  // common to all axes
  std::array<double, kMaxAxes> position{};       // of a latched position, nm or rad
  std::array<double, kMaxAxes> latch_delay_s{};  // of one axis
};

struct ProbeSettings {
  double probe_delay_s = 0.0;                    // from contact to the edge at the drives
  std::array<double, kMaxAxes> latch_delay_s{};  // from the edge to the latch of an axis
  LobingMap radius{};                            // effective, tool frame, nm
  Frame workpiece{};                             // of the part in the frame of the work, nm
  ProbeUncertainty uncertainty{};
};

// What is about to be touched.
struct ProbeFeature {
  std::uint32_t index = 0;
  Vec3 normal = Vec3::Zero();  // out of the part, workpiece frame; a unit vector, or 0: unknown

  [[nodiscard]] bool known() const { return normal.squaredNorm() > 0.0; }
};

struct ProbePoint {
  std::uint32_t sequence = 0;
  std::uint32_t feature = 0;
  TouchVerdict verdict = TouchVerdict::point;
  std::uint8_t axis = 0;
  std::array<std::int64_t, 3> machine{};    // base frame, nm
  std::array<std::int64_t, 3> workpiece{};  // nm
  std::array<float, 3> uncertainty{};       // standard, of the workpiece coordinates, nm
};

class ProbeCorrector {
 public:
  ProbeCorrector() = default;
  // Machine and tool point from now on; the settings stay. As MachineChain::build accepts it.
  [[gnu::cold]] void set_machine(const MachineDescription& machine);

  ProbeSettings settings{};

  // Where the axes stood at the contact.
  [[nodiscard]] LatchedPose contact_pose(const Touch& touch) const;

  // `touch` must have been accepted so far; `error` belongs to its latched positions. The verdict
  // of the point may be another: retracting, centre, uncertified, uncorrected.
  [[nodiscard]] ProbePoint correct(const Touch& touch, const ProbeFeature& feature,
                                   const PoseError& error) const;

 private:
  struct Contact;
  void set_contact(const Touch& touch, const ProbeFeature& feature, const NominalPoint& nominal,
                   Contact& c) const;
  [[nodiscard]] std::array<float, 3> uncertainty(const Contact& contact) const;

  NominalChain chain_{};
  Vec3 tool_point_ = Vec3::Zero();
  Vec3 tool_direction_ = Vec3::Zero();  // unit or 0
};

}  // namespace volcomp
