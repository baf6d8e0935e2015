// Balls with known lobes on artefacts of known size, found again; and how good the uncertainty is.

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "comp/core/units.hpp"
#include "host_sim/host/bus/probe_calibration_file.hpp"
#include "host_sim/host/measure/probe_calibration.hpp"
#include "host_sim/host/measure/probe_settings.hpp"
#include "tests/complaint.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::host {
namespace {

constexpr double kBall_mm = 1.5;
const ProbeArtefact kSphere{ArtefactShape::sphere, 25.0, {}, Axis::z};

// From the equator to the pole, as a sphere on a stem lets them: only upwards.
std::vector<Vec3> upper_half() {
  std::vector<Vec3> all;
  for (const double level : {-10.0, 15.0, 40.0, 65.0, 85.0}) {
    for (int i = 0; i < 12; ++i) {
      const double e = level * kPi / 180.0;
      const double a = (30.0 * i + level) * kPi / 180.0;
      all.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    }
  }
  return all;
}

std::vector<Vec3> round_the_circle() {
  std::vector<Vec3> all;
  for (int i = 0; i < 36; ++i)
    all.emplace_back(std::cos(i * kPi / 18.0), std::sin(i * kPi / 18.0), 0.0);
  return all;
}

double normal(test::Random& random) {  // Box and Muller
  return std::sqrt(-2.0 * std::log(random.in(1e-12, 1.0))) * std::cos(random.in(0.0, 2.0 * kPi));
}

// Touches of a sphere about `centre` in these directions out of it; r(n) is what the ball shows
// there.
template <class Radius>
TouchFile on_sphere(const std::vector<Vec3>& outwards, const Vec3& centre, const Radius& radius) {
  TouchFile file{"touches.csv", {}, false};
  for (const Vec3& n : outwards)
    file.touches.push_back({centre + (0.5 * kSphere.diameter_mm + radius(n)) * n, Vec3::Zero(), 0});
  return file;
}

void expect_map(const LobingMap& found, const LobingMap& wanted, double tolerance) {
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    EXPECT_NEAR(found.coefficient[k], wanted.coefficient[k], tolerance) << "coefficient " << k;
}

// Second and third order, with those that half a sphere hardly separates from a shift upwards.
LobingMap lobes() {
  LobingMap map;
  map.coefficient = {kBall_mm, 0,    0,    0, 0.5e-3, 0,      -0.3e-3, 0.7e-3,
                     0.2e-3,   1e-3, 2e-3, 0, 0,      0.1e-3, 0,       0.4e-3};
  return map;
}

TEST(ProbeCalibration, MapAndPlaceAreFoundFromHalfASphere) {
  const LobingMap map = lobes();
  const Vec3 centre(10.0, -20.0, 330.0);
  const TouchFile file =
      on_sphere(upper_half(), centre, [&](const Vec3& n) { return map.radius(n); });
  const ProbeCalibration c = calibrate_probe(file, kSphere, ProbeModel::lobing);
  expect_map(c.radius, map, 1e-9);
  EXPECT_LT((c.centre - centre).norm(), 1e-9);
  EXPECT_EQ(c.parameters, 16U);
  EXPECT_LT(c.repeatability, 1e-9);
}

// The probe hangs along −Y of the machine: its frame is another, which its normals show.
TEST(ProbeCalibration, MapIsOfTheFrameOfTheNormals) {
  const LobingMap map = lobes();
  const Mat3 to_tool = Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()).toRotationMatrix();
  TouchFile file =
      on_sphere(upper_half(), {1, 2, 3}, [&](const Vec3& n) { return map.radius(to_tool * n); });
  file.has_normals = true;
  const std::vector<Vec3> outwards = upper_half();
  for (std::size_t i = 0; i < outwards.size(); ++i)
    file.touches[i].normal = to_tool * outwards[i];
  const ProbeCalibration c = calibrate_probe(file, kSphere, ProbeModel::lobing);
  expect_map(c.radius, map, 1e-8);
  EXPECT_LT((c.centre - Vec3(1, 2, 3)).norm(), 1e-8);
}

// A tool that turns half round between two rounds of touches separates its eccentricity from the
// place of the sphere.
TEST(ProbeCalibration, TurnedToolShowsItsEccentricity) {
  LobingMap map = lobes();
  map.coefficient[1] = 0.8e-3;
  map.coefficient[2] = -0.4e-3;
  TouchFile file{"touches.csv", {}, true};
  for (const double turn : {0.0, kPi}) {
    const Mat3 to_tool = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    TouchFile round =
        on_sphere(upper_half(), {1, 2, 3}, [&](const Vec3& n) { return map.radius(to_tool * n); });
    for (std::size_t i = 0; i < round.touches.size(); ++i) {
      round.touches[i].normal = to_tool * upper_half()[i];
      file.touches.push_back(round.touches[i]);
    }
  }
  const ProbeCalibration c = calibrate_probe(file, kSphere, ProbeModel::lobing);
  expect_map(c.radius, map, 1e-8);
  EXPECT_LT((c.centre - Vec3(1, 2, 3)).norm(), 1e-8);
}

// In a ring the ball is pushed inwards: its centre is nearer to the middle where it is thicker.
TEST(ProbeCalibration, RingShowsTheMapOfItsPlane) {
  LobingMap map;
  map.coefficient[0] = kBall_mm;
  map.coefficient[7] = 0.6e-3;
  map.coefficient[9] = 1e-3;  // odd: another map if the direction were the other way round
  TouchFile file{"touches.csv", {}, false};
  for (const Vec3& outwards : round_the_circle())
    file.touches.push_back(
        {Vec3(5, 6, 7) + (25.0 - map.radius(-outwards)) * outwards, Vec3::Zero(), 0});
  const ProbeCalibration c =
      calibrate_probe(file, {ArtefactShape::ring, 50.0, {}, Axis::z}, ProbeModel::lobing);
  expect_map(c.radius, map, 1e-9);
  EXPECT_LT((c.centre - Vec3(5, 6, 7)).norm(), 1e-9);
  EXPECT_EQ(c.parameters, 7U);
}

// The uncertainty that is reported is the spread of repeated calibrations.
TEST(ProbeCalibration, UncertaintyIsTheSpreadOfCalibrations) {
  constexpr double kNoise_mm = 0.3e-3;
  constexpr int kTimes = 400;
  test::Random random(11);
  SCOPED_TRACE(random.trace());
  for (const ProbeModel model : {ProbeModel::lobing, ProbeModel::constant}) {
    double spread = 0.0;
    double stated = 0.0;
    double repeatability = 0.0;
    for (int i = 0; i < kTimes; ++i) {
      const TouchFile file = on_sphere(upper_half(), {0, 0, 0}, [&](const Vec3&) {
        return kBall_mm + kNoise_mm * normal(random);
      });
      const ProbeCalibration c = calibrate_probe(file, kSphere, model);
      spread += std::pow(c.radius.coefficient[0] - kBall_mm, 2) / kTimes;
      stated += c.u_effective * c.u_effective / kTimes;
      repeatability += c.repeatability * c.repeatability / kTimes;
    }
    EXPECT_NEAR(std::sqrt(stated / spread), 1.0, 0.12);
    EXPECT_NEAR(std::sqrt(repeatability) / kNoise_mm, 1.0, 0.05);
  }
}

// ± 1 µm (k = 2) of the diameter is 0.25 µm (k = 1) of the radius.
TEST(ProbeCalibration, CertificateOfTheArtefactCounts) {
  ProbeArtefact stated = kSphere;
  stated.expanded_um = 1.0;
  const TouchFile file = on_sphere(upper_half(), {0, 0, 0}, [](const Vec3&) { return kBall_mm; });
  EXPECT_NEAR(calibrate_probe(file, stated, ProbeModel::lobing).u_effective, 0.25e-3, 1e-9);
  EXPECT_NEAR(calibrate_probe(file, stated, ProbeModel::constant).u_map, 0.25e-3, 1e-9);
}

TEST(ProbeCalibration, SettingsAreThoseOfTheNode) {
  ProbeCalibration c;
  c.radius = lobes();
  c.u_map = 0.2e-3;
  c.repeatability = 0.3e-3;
  const std::vector<NodeSetting> settings = probe_settings(c);
  ASSERT_EQ(settings.size(), kLobingTerms + 2);
  EXPECT_EQ(settings[10].index, 0x2302);
  EXPECT_EQ(settings[10].sub, 11);
  EXPECT_DOUBLE_EQ(settings[10].value, 2000.0);
  EXPECT_EQ(settings[0].name, "Effective radius by direction, nm");
  EXPECT_THAT(settings_toml(settings, "a probe"),
              testing::AllOf(testing::StartsWith("# a probe\n\n[[setting]]\nobject = \"2302h:01\""),
                             testing::HasSubstr("object = \"2304h:01\""),
                             testing::HasSubstr("value = 200.0000"),
                             testing::HasSubstr("object = \"2304h:04\"")));
}

// `volcomp setup --probe` reads what `volcomp calibrate-probe --out` writes.
TEST(ProbeCalibration, SettingsComeBackFromTheirFile) {
  ProbeCalibration c;
  c.radius = lobes();
  c.u_map = 0.2e-3;
  c.repeatability = 0.3e-3;
  NodeProbe probe;
  probe.delay_us = 10.0;
  read_probe_calibration(settings_toml(probe_settings(c), "a probe"), "probe.toml", probe);
  constexpr double kPrinted_mm = 1e-4 * 1e-6;  // four decimals of a nanometre
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    EXPECT_NEAR(probe.radius.coefficient.at(k), c.radius.coefficient.at(k), kPrinted_mm) << k;
  EXPECT_NEAR(probe.radius_uncertainty, c.u_map, kPrinted_mm);
  EXPECT_NEAR(probe.repeatability, c.repeatability, kPrinted_mm);
  EXPECT_DOUBLE_EQ(probe.delay_us, 10.0);
}

TEST(ProbeCalibration, AFileOfSettingsThatIsWrongIsRefusedWithItsPlace) {
  ProbeCalibration c;
  c.radius = lobes();
  const std::string good = settings_toml(probe_settings(c), "a probe");
  const auto changed = [&good](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  const auto refusal = [](const std::string& text) {
    NodeProbe probe;
    probe.radius.coefficient[0] = 9.0;
    std::string why = sim::complaint_of([&] { read_probe_calibration(text, "probe.toml", probe); });
    EXPECT_EQ(std::abs(probe.radius.coefficient[0] - 9.0) < 1e-9, why != "accepted") << why;
    return why;
  };
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_THAT(refusal(""), testing::HasSubstr("setting"));
  EXPECT_THAT(refusal("not toml"), testing::HasSubstr("not valid TOML"));
  EXPECT_THAT(refusal(changed("2302h:02", "2302h:01")), testing::HasSubstr("is set twice"));
  EXPECT_THAT(refusal(changed("2302h:02", "2305h:02")), testing::HasSubstr("must be one of"));
  EXPECT_THAT(refusal(changed("unit = \"nm\"", "unit = \"mm\"")), testing::HasSubstr("must be nm"));
  EXPECT_THAT(refusal(changed("value", "valve")), testing::HasSubstr("probe.toml:"));
  EXPECT_THAT(refusal(changed("value = ", "value = nan #")), testing::HasSubstr("probe.toml:"));
  EXPECT_THAT(refusal(changed("value = ", "value = 3e7 #")), testing::HasSubstr("[out_of_range]"));
  EXPECT_THAT(refusal(changed("value = ", "value = -1.0 #")), testing::HasSubstr("[out_of_range]"));
  EXPECT_THAT(refusal(good.substr(0, good.rfind("[[setting]]"))),
              testing::HasSubstr("lacks the setting 2304h:04"));
}

TEST(ProbeCalibration, RefusalsNameWhatIsWrong) {
  const auto round_ball = [](const Vec3&) { return kBall_mm; };
  const auto refusal = [](const TouchFile& file, const ProbeArtefact& artefact = kSphere) {
    return sim::complaint_of([&] { return calibrate_probe(file, artefact, ProbeModel::lobing); });
  };
  TouchFile file = on_sphere(upper_half(), {0, 0, 0}, round_ball);
  EXPECT_EQ(refusal(file), "accepted");
  EXPECT_THAT(refusal(file, {ArtefactShape::sphere, 30.0, {}, Axis::z}),
              testing::HasSubstr("[implausible_radius]"));
  file.touches[7].centre *= 1.1;
  file.touches[7].line = 9;
  EXPECT_THAT(refusal(file), testing::HasSubstr("touches.csv:9: the touch is"));
  EXPECT_THAT(refusal(on_sphere(round_the_circle(), {0, 0, 0}, round_ball)),
              testing::HasSubstr("touches lie in a plane"));
  std::vector<Vec3> few;
  for (std::size_t i = 0; i < 57; i += 3)
    few.push_back(upper_half()[i]);
  EXPECT_THAT(refusal(on_sphere(few, {0, 0, 0}, round_ball)),
              testing::HasSubstr("[too_few_points]"));
}

}  // namespace
}  // namespace volcomp::host
