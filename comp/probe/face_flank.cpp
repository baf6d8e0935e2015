#include "comp/probe/face_flank.hpp"

#include "comp/machine/fine_trig.hpp"

namespace volcomp {
namespace {

Vec3 sum(const Vec3& a, const Vec3& b) { return added(a, 1.0, b); }

}  // namespace

ReliefAt relief_at(const TipRelief& relief, double z) {
  if (!(relief.amount > 0.0) || z >= relief.begin) return {};
  const double along = (relief.begin - z) / relief.length;
  const double twice = 2.0 * relief.amount / relief.length;
  return {relief.amount * along * along, -twice * along, twice / relief.length};
}

FaceTriad::FaceTriad(const FaceGear& gear, const FaceParameters& at) {
  const FineSineCosine beta = fine_sine_cosine_rad(at.beta);
  const FineSineCosine turn = fine_sine_cosine_rad(gear.ratio * (at.theta - gear.theta0 - at.beta));
  beta_sine = beta.sine;
  beta_cosine = beta.cosine;
  turn_sine_ = turn.sine;
  turn_cosine_ = turn.cosine;
}

Vec3 FaceTriad::to_gear(const Vec3& v) const {
  const double y = -beta_sine * v[1] - beta_cosine * v[2];
  const double z = beta_cosine * v[1] - beta_sine * v[2];
  return {turn_cosine_ * v[0] + turn_sine_ * y, turn_cosine_ * y - turn_sine_ * v[0], z};
}

Vec3 FaceTriad::from_gear(const Vec3& v) const {
  const double x = turn_cosine_ * v[0] - turn_sine_ * v[1];
  const double y = turn_sine_ * v[0] + turn_cosine_ * v[1];
  return {x, beta_cosine * v[2] - beta_sine * y, -beta_cosine * y - beta_sine * v[2]};
}

FacePoint face_point(const FaceGear& gear, const FaceFlank& flank, const FaceParameters& at) {
  const FaceTriad triad(gear, at);
  const Vec3 point(gear.arm / triad.beta_cosine, gear.r_bs, -gear.r_bs * at.theta);
  return {from_flank(flank, triad.to_gear(point)),
          from_flank(flank, triad.to_gear(Vec3(0.0, 0.0, 1.0)))};
}

FacePartials face_partials(const FaceGear& gear, const FaceFlank& flank, const FaceParameters& at) {
  const FaceTriad triad(gear, at);
  const double c = triad.beta_cosine;
  const double tangent = triad.beta_sine / c;
  const double i = gear.ratio;
  const double t = gear.r_bs * (at.theta * c - triad.beta_sine);
  const auto out = [&](double e1, double e2) {
    return from_flank(flank, triad.to_gear(Vec3(e1, e2, 0.0)));
  };
  return {out(i * t, gear.r_bs * tangent), out(gear.arm / c * tangent - i * t, t / c),
          out(-i * c, 0.0), out(i * c, -1.0)};
}

// Along e1, e2, n a vector that is fixed in the triad changes by turn × it, with the turns of the
// triad by θ and by β below; to that comes how the components change.
ReliefTangents relief_tangents(const FaceGear& gear, const FaceTriad& triad,
                               const FaceParameters& at) {
  const double s = triad.beta_sine;
  const double c = triad.beta_cosine;
  const double tangent = s / c;
  const double i = gear.ratio;
  const double r = gear.r_bs;
  const double u = gear.arm / c;
  const double t = r * (at.theta * c - s);
  const double z = r * (c + at.theta * s);
  const ReliefAt cut = relief_at(gear.relief, z);
  const double cut_theta = cut.slope * r * s;  // ∂z/∂θ = r s, ∂z/∂β = t
  const double cut_beta = cut.slope * t;
  const double cut_arm_beta = i * (cut_beta * c - cut.depth * s);

  ReliefTangents out;
  out.point = Vec3(u, r, -r * at.theta - cut.depth);
  out.theta = Vec3(i * (t + cut.depth * c), r * tangent, -cut_theta);
  out.beta = Vec3(u * tangent - i * (t + cut.depth * c), t / c + cut.depth, -cut_beta);
  const Vec3 turn_theta(0.0, -i * c, i * s);
  const Vec3 turn_beta(1.0, i * c, -i * s);
  const Vec3 theta_theta(i * c * (r + cut_theta), 0.0, -cut.change * r * s * r * s);
  const Vec3 theta_beta(cut_arm_beta - i * z, r / (c * c),
                        -cut.change * t * r * s - cut.slope * r * c);
  const Vec3 beta_beta(u * (tangent * tangent + 1.0 / (c * c)) + i * z - cut_arm_beta,
                       (t * tangent - z) / c + cut_beta, cut.slope * z - cut.change * t * t);
  out.theta_theta = sum(theta_theta, crossed(turn_theta, out.theta));
  out.theta_beta = sum(theta_beta, crossed(turn_beta, out.theta));
  out.beta_beta = sum(beta_beta, crossed(turn_beta, out.beta));
  return out;
}

FacePoint relieved_face_point(const FaceGear& gear, const FaceFlank& flank,
                              const FaceParameters& at) {
  const FaceTriad triad(gear, at);
  const ReliefTangents tangents = relief_tangents(gear, triad, at);
  const Vec3 inward = crossed(tangents.theta, tangents.beta);
  const Vec3 normal = added(Vec3::Zero(), -1.0 / length(inward), inward);
  return {from_flank(flank, triad.to_gear(tangents.point)),
          from_flank(flank, triad.to_gear(normal))};
}

}  // namespace volcomp
