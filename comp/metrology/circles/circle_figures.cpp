#include "comp/metrology/circles/circle_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "comp/metrology/circles/centred_fit.hpp"

namespace volcomp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CircleRow harmonic_row(double theta) {
  CircleRow row = CircleRow::Zero();
  row[0] = 1.0;
  row[1] = std::cos(theta);
  row[2] = std::sin(theta);
  return row;
}

}  // namespace

Status circle_figures(const CircleTest& test, CircleFigures& out) {
  constexpr std::size_t kLeast = 3;
  if (const Status s = check_readings(test, kLeast); !s.ok()) return s;
  const CentredFit fit =
      fit_centred(test, [](double theta, double /*sense*/) { return harmonic_row(theta); });
  CircleFigures f;
  f.centre = {fit.centre[0], fit.centre[1]};
  f.radius_deviation = fit.x[0];
  f.radial_max = f.centred_max = -kInfinity;
  f.radial_min = f.centred_min = kInfinity;
  for_each_reading(test, [&](double theta, double radial, double /*sense*/) {
    const double p = path_deviation(test.radius, theta, radial, fit.centre);
    f.radial_max = std::max(f.radial_max, radial);
    f.radial_min = std::min(f.radial_min, radial);
    f.centred_max = std::max(f.centred_max, p);
    f.centred_min = std::min(f.centred_min, p);
  });
  f.circular = f.centred_max - f.centred_min;
  out = f;
  return {};
}

}  // namespace volcomp
