#include "host_sim/sim/artefacts/gear.hpp"

#include <cmath>
#include <utility>

#include "comp/core/units.hpp"

namespace volcomp::sim {
namespace {

// An intersection takes the larger distance, a union the smaller.
void intersect(Gap& material, const Gap& with) {
  if (with.mm > material.mm) material = with;
}
void unite(Gap& material, const Gap& with) {
  if (with.mm < material.mm) material = with;
}

constexpr double kDedendum = 1.25;  // of the module: basic rack of ISO 53, profile A

}  // namespace

Gear::Gear(const InvoluteGear& gear, FlankDeviation deviation)
    : gear_(gear), deviation_(std::move(deviation)) {}

Gap Gear::gap(const Vec3& centre, double ball_radius) const {
  const double rho = std::hypot(centre.y(), centre.z());
  if (!(rho > gear_.r_b)) return gap_to_blank(centre, gear_.r_b, ball_radius);
  Gap material = gap_to_blank(centre, gear_.r - kDedendum * gear_.module, ball_radius);
  const int nearest = nearest_tooth(centre);
  for (const int tooth : {nearest - 1, nearest, nearest + 1})
    unite(material, gap_to_tooth((tooth + gear_.teeth) % gear_.teeth, centre, ball_radius));
  return material;
}

int Gear::nearest_tooth(const Vec3& centre) const {
  const double turned = std::tan(gear_.helix_angle) * centre.x() / gear_.r;
  const double angle = std::atan2(centre.z(), centre.y()) - turned;
  const auto pitches = std::lround(angle * gear_.teeth / (2.0 * kPi));
  return static_cast<int>((pitches % gear_.teeth + gear_.teeth) % gear_.teeth);
}

Gap Gear::gap_to_tooth(int tooth, const Vec3& centre, double ball_radius) const {
  Gap material = gap_to_blank(centre, 0.5 * gear_.tip_diameter, ball_radius);
  intersect(material, gap_to_flank({FlankSide::left, tooth}, centre, ball_radius));
  intersect(material, gap_to_flank({FlankSide::right, tooth}, centre, ball_radius));
  return material;
}

// A disc of the gear's width.
Gap Gear::gap_to_blank(const Vec3& centre, double outer_radius, double ball_radius) const {
  const double rho = std::hypot(centre.y(), centre.z());
  const Vec3 radial = rho > 0.0 ? Vec3(0.0, centre.y() / rho, centre.z() / rho) : Vec3::UnitZ();
  Gap material{rho - outer_radius - ball_radius, radial};
  intersect(material, {-centre.x() - ball_radius, -Vec3::UnitX()});
  intersect(material, {centre.x() - gear_.width - ball_radius, Vec3::UnitX()});
  return material;
}

// An involute helicoid and its parallels share their normals, which lean by the base helix angle
// out of the transverse plane.
Gap Gear::gap_to_flank(const Flank& flank, const Vec3& centre, double ball_radius) const {
  FlankDistance d;
  if (!distance_from_flank(gear_, flank, {centre.y(), centre.z()}, centre.x(), d).ok())
    return gap_to_blank(centre, gear_.r_b, ball_radius);
  const double sigma = flank.side == FlankSide::left ? 1.0 : -1.0;
  const double cosine = std::cos(gear_.beta_b);
  const double sine = std::sin(gear_.beta_b);
  const Vec3 normal(-sigma * sine, cosine * d.normal.y, cosine * d.normal.z);
  double distance = d.distance * cosine;
  if (deviation_) {
    // The foot of the normal lies beside the transverse plane of the centre.
    const double roll_length = d.roll_length + d.distance * sine * sine;
    distance -= deviation_(flank, roll_length, centre.x() - distance * normal.x());
  }
  return {distance - ball_radius, normal};
}

}  // namespace volcomp::sim
