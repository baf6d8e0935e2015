// Every derivative of every kind of observation against central differences, on a machine with
// rotary axes under the work.

#include <random>

#include <gtest/gtest.h>

#include "tests/host_sim/host/measure/identify/simulated_plan.hpp"

namespace volcomp::test {
namespace {

class Derivatives : public testing::TestWithParam<ObservationKind> {
 protected:
  Derivatives() {
    const host::MachineFile file = host::read_machine_file(host::bundled_machine("trunnion"));
    problem.machine = machine_of(file);
    setup.kind = GetParam();
    setup.station = Vec3(300.0, -250.0, 420.0);
    setup.length = 100.0;
    setup.normal = Vec3(0.2, -0.3, 0.9).normalized();
    setup.along = Vec3(0.5, 0.4, -0.6).normalized();
    setup.beam = Vec3(10.0, -20.0, 30.0);
    setup.mirror = Vec3(0.52, 0.41, -0.58).normalized();
    setup.pose = Placement{exponential({0.2, -0.1, 0.4}), {20.0, -30.0, 60.0}};
    setup.axis = 3;
    setup.channels = {0, 1, 2, 3, 4, 5};
    setup.lever = Vec3(40.0, -60.0, 80.0);
    at.q = {30.0, -40.0, -120.0, -0.4, 1.1};
    at.tip = Vec3(5.0, 10.0, -160.0);
    at.tip_correction = Vec3(0.02, -0.03, 0.01);
    at.tip_radius = 3.0;
    at.sphere = Vec3(60.0, -40.0, 120.0);
    at.sphere_correction = Vec3(0.01, 0.02, -0.01);
    at.sphere_radius = 10.0;
    at.kappa = 2e-6;
    at.placement = *setup.pose;
    setup.artefact = 0;
    if (!setup.has_pose()) at.local.assign(local_count(problem, setup), 1e-3);
    if (setup.kind == ObservationKind::tracer) at.local = {300.0, -250.0, 420.0, 5.0};
    if (setup.kind == ObservationKind::rtest) at.local = {60.0, -40.0, 120.0};
  }

  [[nodiscard]] std::vector<Reading> readings(const Circumstances& c) const {
    return reading_of(problem, setup, c);
  }

  // Central difference of all components, circumstances changed by ±h.
  template <class Change>
  [[nodiscard]] std::vector<double> difference(double h, const Change& change) const {
    Circumstances up = at;
    Circumstances down = at;
    change(up, h);
    change(down, -h);
    const auto above = readings(up);
    const auto below = readings(down);
    std::vector<double> slope;
    for (std::size_t k = 0; k < above.size(); ++k)
      slope.push_back((above[k].y - below[k].y) / (2.0 * h));
    return slope;
  }

  template <class Change, class Claim>
  void check(const char* what, double h, double scale, const Change& change,
             const Claim& claim) const {
    const auto slope = difference(h, change);
    const auto now = readings(at);
    for (std::size_t k = 0; k < now.size(); ++k)
      EXPECT_NEAR(claim(now[k]), slope[k], 1e-7 * scale)
          << kKindNames.at(static_cast<std::size_t>(setup.kind)) << ' ' << what << ' ' << k;
  }

  Problem problem;
  host::identify::SetUp setup;
  Circumstances at;
};

TEST_P(Derivatives, OfErrors) {
  for (std::size_t a = 0; a < 5; ++a)
    for (Index c = 0; c < 6; ++c)
      check(
          "error", c < 3 ? 1e-3 : 1e-6, c < 3 ? 1.0 : 1000.0,
          [&](Circumstances& s, double h) { s.errors.at(a)(c) += h; },
          [&](const Reading& r) { return r.by_error.at(a)(c); });
}

TEST_P(Derivatives, OfNuisances) {
  if (setup.has_pose()) {
    for (Index k = 0; k < 3; ++k) {
      check(
          "turn", 1e-6, 1000.0,
          [&](Circumstances& s, double h) {
            s.placement.R = exponential(h * Vec3::Unit(k)) * s.placement.R;
          },
          [&](const Reading& r) { return r.by_local(k); });
      check(
          "way", 1e-3, 1.0, [&](Circumstances& s, double h) { s.placement.t(k) += h; },
          [&](const Reading& r) { return r.by_local(3 + k); });
    }
    return;
  }
  for (std::size_t k = 0; k < at.local.size(); ++k) {
    // Tilts of a mirror: about the axes through its nominal normal, first order in them.
    const bool tilt = setup.kind == ObservationKind::step && k < 2;
    check(
        "local", tilt ? 1e-6 : 1e-3, tilt ? 1e4 : 1.0,
        [&](Circumstances& s, double h) { s.local[k] += h; },
        [&](const Reading& r) { return r.by_local(static_cast<Index>(k)); });
  }
}

TEST_P(Derivatives, OfTipSphereAndScale) {
  if (setup.kind == ObservationKind::runs) return;
  for (Index k = 0; k < 3; ++k) {
    check(
        "tip", 1e-3, 1.0, [&](Circumstances& s, double h) { s.tip_correction(k) += h; },
        [&](const Reading& r) { return r.by_tip(k); });
    check(
        "sphere", 1e-3, 1.0, [&](Circumstances& s, double h) { s.sphere_correction(k) += h; },
        [&](const Reading& r) { return r.by_sphere(k); });
  }
  check(
      "radius", 1e-3, 1.0, [&](Circumstances& s, double h) { s.tip_radius += h; },
      [&](const Reading& r) { return r.by_tip_radius; });
  check(
      "scale", 1e-6, 1000.0, [&](Circumstances& s, double h) { s.kappa += h; },
      [&](const Reading& r) { return r.by_kappa; });
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, Derivatives,
                         testing::Values(ObservationKind::tracer, ObservationKind::bar,
                                         ObservationKind::diagonal, ObservationKind::step,
                                         ObservationKind::centre, ObservationKind::touch,
                                         ObservationKind::rtest, ObservationKind::runs),
                         [](const auto& of) {
                           return kKindNames.at(static_cast<std::size_t>(of.param));
                         });

}  // namespace
}  // namespace volcomp::test
