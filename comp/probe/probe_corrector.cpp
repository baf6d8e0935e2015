#include "comp/probe/probe_corrector.hpp"

#include <cmath>

#include "comp/core/to_double.hpp"
#include "comp/core/units.hpp"
#include "comp/machine/double3.hpp"
#include "comp/machine/machine_limits.hpp"
#include "comp/tables/table_set.hpp"

namespace volcomp {
namespace {

constexpr double kRadPerUnit = 1.0 / kUnitsPerRad;

// Counted through to at most half a turn either way: what a double holds exactly.
double within_a_turn(std::int64_t position) {
  constexpr unsigned kRest = 24;  // of 64 bits beside the 40 of a turn
  const std::uint64_t phase = static_cast<std::uint64_t>(position) << kRest;
  return to_double(static_cast<std::int64_t>(phase) >> kRest);
}

// Every coordinate of a point: all axes along one line, links of 5 m from corner to corner, the
// tables and 16 terms of the radius, each below 2. Positions of the axes are nearly all of it.
constexpr double kMaxLink_nm = 2.0 * kMaxOffset_mm * kNmPerMm;
constexpr double kMaxCoordinate_nm = static_cast<double>(kMaxAxes) * kMaxContact_nm +
                                     static_cast<double>(kMaxBodies + 1) * kMaxLink_nm +
                                     2.0 * kMaxBound_nm + 32.0 * kMaxBallRadius_nm +
                                     2.0 * kMaxPart_nm;
static_assert(kMaxCoordinate_nm < 0x1p63);

// Half away from zero. |value| < 2^63
std::int64_t to_integer(double value) {
  const double magnitude = (value < 0.0 ? -value : value) + 0.5;
  const auto high = static_cast<std::uint32_t>(magnitude * (1.0 / kWord));
  const auto low = static_cast<std::uint32_t>(magnitude - static_cast<double>(high) * kWord);
  const std::uint64_t whole = static_cast<std::uint64_t>(high) << 32U | low;
  return static_cast<std::int64_t>(value < 0.0 ? 0U - whole : whole);
}

std::array<std::int64_t, 3> to_integers(const Vec3& v) {
  return {to_integer(v[0]), to_integer(v[1]), to_integer(v[2])};
}

double square(double x) { return x * x; }

}  // namespace

// What the point and its uncertainty depend on, in the workpiece frame unless stated otherwise.
struct ProbeCorrector::Contact {
  Vec3 normal;            // unit or 0
  bool directed = false;  // it is not 0
  Vec3 normal_base;       // the same in base
  double radius = 0.0;    // effective, nm
  Vec3 tool;              // direction of the tool vector, unit or 0
  Vec3 velocity;          // of the point, nm/s
  Vec3 axes_variance;     // what the axes add to the variance of each coordinate, nm²
};

void ProbeCorrector::set_machine(const MachineDescription& machine) {
  chain_.build(machine);
  tool_point_ =
      Vec3(machine.tool_point[0], machine.tool_point[1], machine.tool_point[2]) * kNmPerMm;
  const double arm = length(tool_point_);
  tool_direction_ = arm > 0.0 ? Vec3(tool_point_ / arm) : Vec3::Zero();
}

LatchedPose ProbeCorrector::contact_pose(const Touch& touch) const {
  LatchedPose q;  // NOLINT(cppcoreguidelines-pro-type-member-init) as far as the chain reads
  for (std::size_t a = 0; a < chain_.axes(); ++a) {
    const LatchedAxis& l = touch.latched[a];
    const double delay_s = settings.probe_delay_s + settings.latch_delay_s[a];
    const double latched = chain_.rotary(a) ? within_a_turn(l.position) : to_double(l.position);
    q[a] = latched - l.velocity * delay_s;
  }
  return q;
}

void ProbeCorrector::set_contact(const Touch& touch, const ProbeFeature& feature,
                                 const NominalPoint& nominal, Contact& c) const {
  const ProbeUncertainty& u = settings.uncertainty;
  const Mat3& part_to_base = nominal.part_to_base;
  c.normal = feature.normal;
  c.normal_base = turned(part_to_base, feature.normal);
  c.directed = feature.known();
  if (c.directed)
    c.radius = settings.radius.radius(turned_back(nominal.tool_to_base, c.normal_base));
  c.tool = turned_back(part_to_base, turned(nominal.tool_to_base, tool_direction_));
  Vec3 velocity = Vec3::Zero();
  Vec3 axes_variance = Vec3::Zero();
  for (std::size_t a = 0; a < chain_.axes(); ++a) {
    const double v = touch.latched[a].velocity;
    const double speed = chain_.rotary(a) ? v * kRadPerUnit : v;
    const double variance = square(u.position[a]) + square(speed * u.latch_delay_s[a]);
    const Vec3 column = turned_back(part_to_base, nominal.column[a]);
    velocity = added(velocity, speed, column);
    axes_variance = added(axes_variance, variance, column.cwiseAbs2());
  }
  c.velocity = velocity;
  c.axes_variance = axes_variance;
}

VOLCOMP_FLATTEN ProbePoint ProbeCorrector::correct(const Touch& touch, const ProbeFeature& feature,
                                                   const PoseError& error) const {
  NominalPoint nominal;  // NOLINT(cppcoreguidelines-pro-type-member-init) both are set by the calls
  Contact c;             // NOLINT(cppcoreguidelines-pro-type-member-init)
  chain_.at(contact_pose(touch), tool_point_, settings.workpiece, nominal);
  set_contact(touch, feature, nominal, c);
  const Vec3 centre = added(nominal.base, 1.0, error.base);
  const Vec3 error_part = turned_back(nominal.part_to_base, error.base);
  const Vec3 centre_part = added(nominal.part, 1.0, error_part);

  TouchVerdict verdict = c.directed ? TouchVerdict::point : TouchVerdict::centre;
  if (!error.within) verdict = TouchVerdict::uncertified;
  if (!error.known) verdict = TouchVerdict::uncorrected;
  if (c.directed && c.velocity.dot(c.normal) >= 0.0) verdict = TouchVerdict::retracting;
  return {touch.sequence,
          feature.index,
          verdict,
          touch.axis,
          to_integers(added(centre, -c.radius, c.normal_base)),
          to_integers(added(centre_part, -c.radius, c.normal)),
          uncertainty(c)};
}

// First order (JCGM 100, 5.1.2 and 5.2.2). Radius and tool length act in opposite senses.
std::array<float, 3> ProbeCorrector::uncertainty(const Contact& c) const {
  const ProbeUncertainty& u = settings.uncertainty;
  const double across = square(c.radius * u.normal);
  const double along = square(u.radius) + square(u.repeatability) - across;
  const double both = 2.0 * u.correlation * u.radius * u.tool_length;
  const double everywhere = square(u.tables) + across;
  std::array<float, 3> out;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int k = 0; k < 3; ++k) {
    const double variance = everywhere + square(c.normal[k]) * along -
                            c.normal[k] * c.tool[k] * both + square(c.tool[k] * u.tool_length) +
                            square(c.velocity[k] * u.probe_delay_s) + c.axes_variance[k];
    // Errors that cancel leave what rounding makes of 0, of either sign.
    out[static_cast<std::size_t>(k)] =
        variance > 0.0 ? std::sqrt(static_cast<float>(variance)) : 0.0F;
  }
  return out;
}

}  // namespace volcomp
