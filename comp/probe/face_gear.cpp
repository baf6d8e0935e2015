#include "comp/probe/face_gear.hpp"

#include <array>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/machine/fine_trig.hpp"
#include "comp/probe/face_kernel.hpp"

namespace volcomp {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr int kHalvings = 60;

Status refuse_field(const char* field, double value) {
  return refuse_value(Reason::bad_gear, field, value);
}

// NaN is never within.
VOLCOMP_SHARED bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

struct Field {
  const char* name;
  double FaceGear::*value;
  double low;
  double high;
};
constexpr std::array<Field, 4> kFields{
    {{"module", &FaceGear::module, 0.01, 100.0},
     {"pressure_angle", &FaceGear::pressure_angle, 10.0 * kDegree, 35.0 * kDegree},
     {"addendum", &FaceGear::addendum, 0.01, 2.0},
     {"shaper_addendum", &FaceGear::shaper_addendum, 0.01, 2.0}}};

// What the other fields are computed from.
Status check_given(const FaceGear& g) {
  if (g.shaper_teeth < 5) return refuse_field("shaper_teeth", g.shaper_teeth);
  if (g.teeth <= g.shaper_teeth || g.teeth > kMaxFaceGearTeeth)
    return refuse_field("teeth", g.teeth);
  for (const Field& field : kFields) {
    const double value = g.*field.value;
    if (!within(value, field.low, field.high)) return refuse_field(field.name, value);
  }
  const TipRelief& relief = g.relief;
  if (!within(relief.amount, 0.0, 0.2 * g.module))
    return refuse_field("relief.amount", relief.amount);
  if (!(relief.amount > 0.0)) return {};
  if (!within(relief.length, 0.1 * g.module, 10.0 * g.module))
    return refuse_field("relief.length", relief.length);
  if (!std::isfinite(relief.begin)) return refuse_field("relief.begin", relief.begin);
  return {};
}

void set_constants(FaceGear& g) {
  const FineSineCosine alpha = fine_sine_cosine_rad(g.pressure_angle);
  g.ratio = static_cast<double>(g.shaper_teeth) / g.teeth;
  g.r_ps = 0.5 * g.module * g.shaper_teeth;
  g.r_bs = g.r_ps * alpha.cosine;
  g.r_pitch = 0.5 * g.module * g.teeth;
  g.arm = g.r_pitch * alpha.cosine;
  const double involute = alpha.sine / alpha.cosine - g.pressure_angle;
  g.theta0 = kPi / (2.0 * g.shaper_teeth) + involute;
  const double tip = (g.r_ps + g.shaper_addendum * g.module) / g.r_bs;
  g.theta_tip = mid_range_root((tip - 1.0) * (tip + 1.0));
  g.z_tip = g.r_ps - g.addendum * g.module;
}

// The undercut reaches higher the nearer to the axis; here it begins at the fillet.
void find_undercut(FaceGear& g) {
  double low = 0.0;
  double high = 1.4;
  for (int i = 0; i < kHalvings; ++i) {
    const double beta = 0.5 * (low + high);
    (undercut_roll(g, beta) < g.theta_tip ? low : high) = beta;
  }
  g.undercut_beta = 0.5 * (low + high);
  const FineSineCosine beta = fine_sine_cosine_rad(g.undercut_beta);
  const double u = g.arm / beta.cosine;
  const double t = g.r_bs * (g.theta_tip * beta.cosine - beta.sine);
  g.undercut_radius = mid_range_root(u * u + t * t);
}

// Where a slot is as wide as a pitch at the tips. Slots get wider outwards.
void find_pointing(FaceGear& g) {
  double low = g.undercut_radius;
  double high = 3.0 * g.arm;
  for (int i = 0; i < kHalvings; ++i) {
    const double radius = 0.5 * (low + high);
    (half_slot_angle(g, radius, g.z_tip) < kPi / g.teeth ? low : high) = radius;
  }
  g.pointing_radius = 0.5 * (low + high);
}

}  // namespace

Status derive(FaceGear& gear) {
  FaceGear g = gear;
  if (const Status s = check_given(g); !s.ok()) return s;
  set_constants(g);
  find_undercut(g);
  find_pointing(g);
  if (within(g.r_in, 0.0, 0.0)) g.r_in = g.undercut_radius;
  if (within(g.r_out, 0.0, 0.0)) g.r_out = g.pointing_radius;
  if (!within(g.r_in, g.undercut_radius, g.pointing_radius)) return refuse_field("r_in", g.r_in);
  if (!within(g.r_out, g.r_in, g.pointing_radius)) return refuse_field("r_out", g.r_out);
  gear = g;
  return {};
}

double undercut_roll(const FaceGear& gear, double beta) {
  const FineSineCosine at = fine_sine_cosine_rad(beta);
  const double q = 2.0 / (gear.ratio * at.cosine);
  return 0.5 * (at.sine / at.cosine) * (1.0 + mid_range_root(1.0 + q * q));
}

double half_slot_angle(const FaceGear& gear, double rho, double z) {
  FaceSection section;
  if (cut_flank(gear, rho * rho, z, section) != Reason::ok)
    return std::numeric_limits<double>::quiet_NaN();
  return fine_arc_tangent(section.t, gear.arm * section.inverse_cosine) - section.slot_turn;
}

double tooth_thickness(const FaceGear& gear, double rho, double z) {
  return 2.0 * rho * (kPi / gear.teeth - half_slot_angle(gear, rho, z));
}

FaceGear face_gear_of_table_1() {
  FaceGear gear;
  gear.shaper_teeth = 22;
  gear.teeth = 142;
  gear.module = 3.9;
  gear.pressure_angle = 25.0 * kDegree;
  gear.r_in = 253.5;
  gear.r_out = 305.0;
  return derive(gear).ok() ? gear : FaceGear{};
}

FaceGear face_gear_of_table_3() {
  FaceGear gear;
  gear.shaper_teeth = 25;
  gear.teeth = 86;
  gear.module = 4.0;
  gear.pressure_angle = 25.0 * kDegree;
  gear.relief = {0.060, 48.4, 2.4};
  return derive(gear).ok() ? gear : FaceGear{};
}

}  // namespace volcomp
