#pragma once
// The squareness that the tables of a machine show on the circles of a ball bar: what is subtracted
// from the measured one (squareness closure, docs/papers/xyfz.md). Evaluated as the measurement is,
// with the same places and radius: then form errors of the axes leak into both alike. Lines instead
// of circles would leave them in the tables (docs/ball-bar.md).

#include <array>
#include <cmath>
#include <cstddef>

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/circles/circle_decomposition.hpp"

namespace volcomp {

// Three full circles about one point, in the planes XY, ZX and YZ; mm.
struct SquarenessCircles {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

inline constexpr std::size_t kSquarenessReadings = 360;

namespace detail {

// Squareness of one plane as CircleParameters has it, rad.
template <class ErrorAt>
Status circle_squareness(const ErrorAt& error_at, const SquarenessCircles& circles, Axis first,
                         Axis second, double& out) {
  constexpr double kTwoPi = 6.283185307179586;
  const auto a = static_cast<Eigen::Index>(first);
  const auto b = static_cast<Eigen::Index>(second);
  std::array<double, kSquarenessReadings> theta{};
  std::array<double, kSquarenessReadings> radial{};
  for (std::size_t i = 0; i < theta.size(); ++i) {
    theta[i] = kTwoPi * static_cast<double>(i) / static_cast<double>(theta.size());
    const double along = circles.radius * std::cos(theta[i]);
    const double across = circles.radius * std::sin(theta[i]);
    Vec3 q = circles.centre;
    q(a) += along;
    q(b) += across;
    const Vec3 error = error_at(q);
    radial[i] = std::hypot(along + error(a), across + error(b)) - circles.radius;
  }
  CircleSettings settings;
  settings.first = first;
  settings.second = second;
  CircleDecomposition d;
  const CircleTest test{
      circles.radius, {{theta.data(), theta.size()}, {radial.data(), radial.size()}}, {}};
  if (const Status s = decompose_circle(test, settings, {}, d); !s.ok()) return s;
  out = d.value.squareness;
  return {};
}

}  // namespace detail

// `error_at(Vec3 q)` returns the volumetric error, mm. Refused: as decompose_circle.
template <class ErrorAt>
Status squareness_on_circles(const ErrorAt& error_at, const SquarenessCircles& circles,
                             XyfzSquareness& out) {
  double xy = 0.0;
  double zx = 0.0;
  double yz = 0.0;
  using detail::circle_squareness;
  if (const Status s = circle_squareness(error_at, circles, Axis::x, Axis::y, xy); !s.ok())
    return s;
  if (const Status s = circle_squareness(error_at, circles, Axis::z, Axis::x, zx); !s.ok())
    return s;
  if (const Status s = circle_squareness(error_at, circles, Axis::y, Axis::z, yz); !s.ok())
    return s;
  out = {-xy, zx, yz};  // of EC0Y, EB0Z, EA0Z
  return {};
}

}  // namespace volcomp
