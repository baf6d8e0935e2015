#include "comp/metrology/circles/circle_decomposition.hpp"

#include <algorithm>
#include <cmath>

#include "comp/metrology/circles/centred_fit.hpp"

namespace volcomp {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// Columns of the fit.
constexpr int kRadius = 0;
constexpr int kCentre = 1;
constexpr int kScale = 3;
constexpr int kSquareness = 4;
constexpr int kServo = 5;
constexpr int kReversal = 6;
constexpr int kLateral = 8;
constexpr int kCyclic = 10;
static_assert(kCyclic + 4 == kCircleColumns);

double sign(double x) {
  constexpr double kZero = 1e-9;
  return x > kZero ? 1.0 : x < -kZero ? -1.0 : 0.0;
}

class Columns {
 public:
  Columns(const CircleTest& test, const CircleSettings& settings)
      : radius_(test.radius), both_(test.both()), wavelength_(settings.cyclic_wavelength) {}

  CircleRow operator()(double theta, double sense) const {
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    CircleRow row = CircleRow::Zero();
    row.head<5>() << 1.0, c, s, std::cos(2.0 * theta), std::sin(2.0 * theta);
    if (both_) {
      const double half = 0.5 * sense;
      row[kServo] = sense * row[kSquareness];
      row.segment<2>(kReversal) << -half * sign(s) * c, half * sign(c) * s;
      row.segment<2>(kLateral) << -half * std::abs(s), half * std::abs(c);
    }
    set_cyclic(row, kCyclic, c, wavelength_[0]);
    set_cyclic(row, kCyclic + 2, s, wavelength_[1]);
    return row;
  }

 private:
  // An error of one axis, periodic in its way, as far as it points along the bar.
  void set_cyclic(CircleRow& row, int at, double part, double wavelength) const {
    if (!(wavelength > 0.0)) return;
    const double phase = kTwoPi * radius_ * part / wavelength;
    row[at] = part * std::cos(phase);
    row[at + 1] = part * std::sin(phase);
  }

  double radius_;
  bool both_;
  std::array<double, 2> wavelength_;
};

// The slope sum of two axes has its own sign in the tables: EC0Y = −a, EA0Z = −a, EB0Z = +a
// (conventions, squareness).
double squareness_sign(const CircleSettings& settings) {
  const bool with_y = settings.first == Axis::y || settings.second == Axis::y;
  return with_y ? -1.0 : 1.0;
}

CircleParameters parameters_of(const CircleVector& x, const CircleTest& test,
                               const CircleSettings& settings) {
  CircleParameters p;
  p.radius = x[kRadius];
  p.scale_mismatch = 2.0 * x[kScale] / test.radius;
  p.squareness = squareness_sign(settings) * 2.0 * x[kSquareness] / test.radius;
  p.reversal = {x[kReversal], x[kReversal + 1]};
  p.lateral = {x[kLateral], x[kLateral + 1]};
  if (test.both()) p.servo_mismatch = 2.0 * x[kServo] / settings.feed;
  return p;
}

Status check_settings(const CircleTest& test, const CircleSettings& settings) {
  if (!(test.radius > 0.0) || !std::isfinite(test.radius))
    return refuse_value(Reason::bad_setting, "radius", test.radius);
  if (settings.first == settings.second)
    return refuse_value(Reason::bad_setting, "first", static_cast<double>(settings.first));
  const bool feeds = settings.feed > 0.0 && std::isfinite(settings.feed);
  if (test.both() && !feeds) return refuse_value(Reason::bad_setting, "feed", settings.feed);
  for (const double wavelength : settings.cyclic_wavelength) {
    if (!(wavelength >= 0.0) || !std::isfinite(wavelength))
      return refuse_value(Reason::bad_setting, "cyclic_wavelength", wavelength);
  }
  return {};
}

void put_residuals(const CircleTrace& trace, double sense, double radius, const CentredFit& fit,
                   const Columns& columns, Span<double> out) {
  if (out.size() != trace.theta.size()) return;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double p = path_deviation(radius, trace.theta[i], trace.radial[i], fit.centre);
    out[i] = p - columns(trace.theta[i], sense).dot(fit.x);
  }
}

}  // namespace

Status decompose_circle(const CircleTest& test, const CircleSettings& settings,
                        const CircleResiduals& residuals, CircleDecomposition& out) {
  if (const Status s = check_settings(test, settings); !s.ok()) return s;
  if (const Status s = check_readings(test, std::size_t{2} * kCircleColumns); !s.ok()) return s;
  const Columns columns(test, settings);
  const CentredFit fit = fit_centred(test, columns);
  CircleDecomposition d;
  d.rms = fit.rms;
  d.value = parameters_of(fit.x, test, settings);
  d.value.centre = {fit.centre[0], fit.centre[1]};
  const CircleVector u = fit.rms * fit.factor;
  d.u = parameters_of(u, test, settings);
  d.u.squareness = std::abs(d.u.squareness);
  d.u.centre = {u[kCentre], u[kCentre + 1]};
  d.cyclic = {std::hypot(fit.x[kCyclic], fit.x[kCyclic + 1]),
              std::hypot(fit.x[kCyclic + 2], fit.x[kCyclic + 3])};
  put_residuals(test.ccw, 1.0, test.radius, fit, columns, residuals.ccw);
  put_residuals(test.cw, -1.0, test.radius, fit, columns, residuals.cw);
  out = d;
  return {};
}

}  // namespace volcomp
