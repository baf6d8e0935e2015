#include "host_sim/experiments/internal_helical/grinder_plant.hpp"

#include <cmath>

namespace volcomp::internal_helical {
namespace {

double mm_of(std::int64_t nm) { return static_cast<double>(nm) / kNmPerMm; }
double rad_of(std::int64_t units) { return static_cast<double>(units) / kWirePerRad; }

std::int64_t encoder(double value, double resolution, double units) {
  return to_units(std::round(value / resolution) * resolution, units);
}

// An Euler step: at constant feed the lag is v / K_v exactly. An axis does arrive in the end: how
// long it has rested then makes no difference in any bit.
double step(double at, double demand, double gain) {
  constexpr double kArrived = 1e-12;  // mm or rad
  const double away = demand - at;
  return std::abs(away) < kArrived ? demand : at + gain * kStrokeTick_s * away;
}

}  // namespace

GrinderPlant::GrinderPlant(const InternalGear& gear, const GrindingTruth& truth,
                           const StrokeStep& standing, std::uint64_t seed)
    : truth_(truth), random_(seed), x_(standing.x), z_(mm_of(standing.z)), c_(rad_of(standing.c)) {
  for (int k = 0; k < gear.teeth; ++k)
    slot_error_.push_back(random_.normal(truth.slot_rms_rad));
}

void GrinderPlant::begin_pass(std::uint16_t slot) {
  slot_ = slot;
  pass_error_ = random_.normal(truth_.pass_rms_rad);
  x_error_ = random_.normal(truth_.hunting_rms_mm);
}

double GrinderPlant::true_z() const {
  return z_ + truth_.ripple_mm * std::sin(2.0 * kPi * z_ / truth_.ripple_wavelength_mm);
}

double GrinderPlant::c_error() const {
  return truth_.visible_rad * std::cos(c_ + truth_.visible_phase) + slot_error_.at(slot_) +
         pass_error_;
}

std::int64_t GrinderPlant::read_x() const {
  return x_ + encoder(x_error_, truth_.resolution_z_mm, kNmPerMm);
}
std::int64_t GrinderPlant::read_z() const {
  return encoder(true_z(), truth_.resolution_z_mm, kNmPerMm);
}
std::int64_t GrinderPlant::read_c() const {
  return encoder(c_ + c_error(), truth_.resolution_c_rad, kWirePerRad);
}

void GrinderPlant::follow_z(std::int64_t demand) { z_ = step(z_, mm_of(demand), truth_.gain_z); }
void GrinderPlant::follow_c(std::int64_t demand) { c_ = step(c_, rad_of(demand), truth_.gain_c); }

LagErrors GrinderPlant::errors(const StrokeStep& command) const {
  LagErrors e;
  e.z = true_z();
  e.e_x = mm_of(x_ - command.x) + x_error_;
  e.e_z = e.z - mm_of(command.z);
  e.e_c = c_ - rad_of(command.c) + c_error();
  return e;
}

}  // namespace volcomp::internal_helical
