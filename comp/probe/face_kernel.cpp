#include "comp/probe/face_kernel.hpp"

#include "comp/machine/fine_trig.hpp"

namespace volcomp {
namespace {

constexpr double kInnerLimit = 1.0005;      // of C
constexpr double kFlattest = 1.00020003;    // 1/cos 0.02
constexpr double kSteepest = 5.8834900848;  // 1/cos 1.4

struct Newton {
  double w;
  int steps;
  bool settled;
};

// With w = 1/cos β the equation of the section, u² + t² = ρ², is a polynomial, in units of C:
// (w² − ρ²)(w² − 1) + (z − i w)² = 0. ρ/C is at or beyond its largest root, the one wanted, and
// from there the steps fall towards it.
Newton largest_root(double ratio, double square, double z) {
  double w = mid_range_root(square);
  for (int step = 1; step <= kMaxFaceSteps; ++step) {
    const double w2 = w * w;
    const double d = z - ratio * w;
    const double value = (w2 - square) * (w2 - 1.0) + d * d;
    const double slope = 2.0 * (w * (2.0 * w2 - 1.0 - square) - ratio * d);
    if (!(slope > 0.0)) break;
    const double change = value / slope;
    w -= change;
    if (!(w >= kFlattest && w <= kSteepest)) break;
    // What a further step would still change is half of the second derivative, at most 6 w², times
    // the square of this one over the slope: nothing.
    if (6.0 * w2 * change * change <= 4e-16 * slope) return {w, step, true};
  }
  return {w, kMaxFaceSteps, false};
}

// θ > θ_u(β) = tan β/2 (1 + √(1 + (2/(i cos β))²)), without the root.
bool beyond_undercut(const FaceGear& gear, const FaceSection& at, double theta) {
  const double excess = 2.0 * theta - at.tangent;
  const double q = 2.0 * at.inverse_cosine * at.tangent;
  return excess > 0.0 &&
         gear.ratio * gear.ratio * (excess * excess - at.tangent * at.tangent) > q * q;
}

Reason verdict_on(const FaceGear& gear, const FaceSection& at, double theta, double z) {
  if (theta < 0.0) return Reason::below_involute;
  if (beyond_undercut(gear, at, theta)) return Reason::undercut;
  if (theta > gear.theta_tip) return Reason::in_fillet;
  if (z < gear.z_tip) return Reason::above_tip;
  return Reason::ok;
}

bool finite(const Vec3& q) {
  const double sum = q[0] + q[1] + q[2];
  return sum - sum <= 0.0;
}

// A point in the frame of its flank.
struct Place {
  Place(const FaceFlank& flank, const Vec3& q)
      : p(to_flank(flank, q)), rho_squared(sum_of_products(q[0], q[0], q[1], q[1])) {}
  Vec3 p;
  double rho_squared;
};

void set_foot(const FaceGear& gear, const FaceFlank& flank, const FaceSection& at,
              const Place& place, FaceFoot& foot) {
  const Vec3& p = place.p;
  // The gear turn that brings the section to the point is the one its foot was cut at.
  const double u = gear.arm * at.inverse_cosine;
  const double along = sum_of_products(u, p[0], at.t, p[1]);
  const double across = sum_of_products(at.t, p[0], -u, p[1]);
  foot.steps = at.steps;
  foot.distance = gear.arm * (fine_arc_tangent(across, along) - at.slot_turn);
  foot.beta = at.beta;
  foot.theta = at.roll + foot.distance / gear.r_bs;
  const double c = 1.0 / at.inverse_cosine;
  const double scale = -c / place.rho_squared;
  const Vec3 normal(scale * across, scale * along, -at.tangent * c);
  const Vec3 point = added(p, -foot.distance, normal);
  foot.point = from_flank(flank, point);
  foot.normal = from_flank(flank, normal);
  foot.reason = verdict_on(gear, at, foot.theta, point[2]);
}

}  // namespace

FaceFoot::FaceFoot() = default;

Status choose_flank(const FaceGear& gear, int side, int slot, FaceFlank& out) {
  if (side != 1 && side != -1) return refuse_value(Reason::bad_point, "side", side);
  if (slot < 0 || slot >= gear.teeth) return refuse_value(Reason::bad_point, "slot", slot);
  const double turns = static_cast<double>(slot) / gear.teeth;
  const FineSineCosine at = fine_sine_cosine(turns * static_cast<double>(kUnitsPerTurn));
  out = {static_cast<double>(side), at.cosine, at.sine};
  return {};
}

Reason cut_flank(const FaceGear& gear, double rho_squared, double z, FaceSection& out) {
  const double scale = 1.0 / gear.arm;
  const double square = rho_squared * scale * scale;
  if (!(square > kInnerLimit * kInnerLimit)) return Reason::inside_gear_base;
  if (!(square <= kSteepest * kSteepest)) return Reason::no_regular_flank;
  const Newton root = largest_root(gear.ratio, square, z * scale);
  if (!root.settled) return Reason::no_regular_flank;
  const double w = root.w;
  const double tangent = mid_range_root((w - 1.0) * (w + 1.0));
  out.inverse_cosine = w;
  out.tangent = tangent;
  out.beta = fine_arc_tangent(tangent, 1.0);
  out.t = (z - gear.r_bs * w) / tangent;
  out.roll = out.t * w / gear.r_bs + tangent;
  out.slot_turn = gear.ratio * (out.roll - gear.theta0 - out.beta);
  out.steps = root.steps;
  return Reason::ok;
}

FaceFoot distance_from_face(const FaceGear& gear, const FaceFlank& flank, const Vec3& q) {
  const Place place(flank, q);
  FaceFoot foot;
  if (!finite(q)) return foot;
  FaceSection at;
  foot.reason = cut_flank(gear, place.rho_squared, q[2], at);
  if (foot.reason == Reason::ok) set_foot(gear, flank, at, place, foot);
  return foot;
}

FaceFeet distances_in_slot(const FaceGear& gear, const FaceFlank& flank, const Vec3& q) {
  Place place(flank, q);
  FaceFeet feet;
  if (!finite(q)) return feet;
  FaceSection at;
  feet.here.reason = feet.opposite.reason = cut_flank(gear, place.rho_squared, q[2], at);
  if (feet.here.reason != Reason::ok) return feet;
  set_foot(gear, flank, at, place, feet.here);
  place.p[1] = -place.p[1];  // the mirror image
  set_foot(gear, {-flank.side, flank.cosine, flank.sine}, at, place, feet.opposite);
  return feet;
}

}  // namespace volcomp
