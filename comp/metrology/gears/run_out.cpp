#include "comp/metrology/gears/run_out.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

constexpr double kPi = 3.141592653589793;

double involute(double angle) { return std::tan(angle) - angle; }

// The angle with this involute, 0…π/2; it is monotone there.
double angle_of_involute(double value) {
  constexpr int kHalvings = 60;
  double low = 0.0;
  double high = 0.5 * kPi;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (involute(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Status check(const BallInSpace& b) {
  const auto between = [](double x, double low, double high) { return x > low && x < high; };
  if (b.teeth < 1) return refuse_value(Reason::bad_setting, "teeth", b.teeth);
  if (!between(b.module, 0.0, HUGE_VAL))
    return refuse_value(Reason::bad_setting, "module", b.module);
  if (!between(b.pressure_angle, 0.0, 0.5 * kPi))
    return refuse_value(Reason::bad_setting, "pressure_angle", b.pressure_angle);
  if (!between(b.helix_angle, -0.5 * kPi, 0.5 * kPi))
    return refuse_value(Reason::bad_setting, "helix_angle", b.helix_angle);
  if (!std::isfinite(b.shift)) return refuse_value(Reason::bad_setting, "shift", b.shift);
  if (!between(b.diameter, 0.0, HUGE_VAL))
    return refuse_value(Reason::bad_setting, "diameter", b.diameter);
  return {};
}

Status check_round(int teeth, Span<const double> values, const char* field) {
  Where where;
  where.field = field;
  where.count = static_cast<int>(values.size());
  if (values.size() != static_cast<std::size_t>(teeth)) return refuse(Reason::incomplete, where);
  where.count = -1;
  for (std::size_t k = 0; k < values.size(); ++k) {
    where.index = static_cast<int>(k);
    if (!std::isfinite(values[k])) return refuse(Reason::not_finite, where);
  }
  return {};
}

}  // namespace

Status ball_seat(const BallInSpace& b, BallSeat& out) {
  if (const Status s = check(b); !s.ok()) return s;
  const auto z = static_cast<double>(b.teeth);
  const double transverse = std::atan(std::tan(b.pressure_angle) / std::cos(b.helix_angle));
  const double wanted = involute(transverse) +
                        b.diameter / (z * b.module * std::cos(b.pressure_angle)) - 0.5 * kPi / z +
                        2.0 * b.shift * std::tan(b.pressure_angle) / z;
  if (!(wanted > 0.0)) return refuse_value(Reason::out_of_reach, "diameter", b.diameter);
  const double base = 0.5 * z * b.module / std::cos(b.helix_angle) * std::cos(transverse);
  const double angle = angle_of_involute(wanted);
  out = {angle, base / std::cos(angle)};
  return {};
}

Status check_spaces(int teeth, Span<const double> left, Span<const double> right) {
  if (const Status s = check_round(teeth, left, "left"); !s.ok()) return s;
  return check_round(teeth, right, "right");
}

Status run_out(const BallInSpace& ball, Span<const double> left, Span<const double> right,
               Span<double> radial, RunOut& out) {
  if (const Status s = check_spaces(ball.teeth, left, right); !s.ok()) return s;
  BallSeat seat;
  if (const Status s = ball_seat(ball, seat); !s.ok()) return s;
  if (radial.size() != left.size()) return refuse(Reason::length_mismatch);
  const auto z = static_cast<double>(ball.teeth);
  double cosine = 0.0;
  double sine = 0.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    radial[k] = 0.5 * (left[k] + right[k]) / std::sin(seat.pressure_angle);
    const double phase = 2.0 * kPi * static_cast<double>(k) / z;
    cosine += radial[k] * std::cos(phase);
    sine += radial[k] * std::sin(phase);
  }
  const auto [least, most] = std::minmax_element(radial.begin(), radial.end());
  out = {*most - *least, 2.0 / z * std::hypot(cosine, sine)};
  return {};
}

}  // namespace volcomp
