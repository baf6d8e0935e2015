// What axis errors leave on the flank: sensitivities and figures for the machine of
// docs/papers/internal-helical.md, and the first order against the exact envelope.

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

constexpr double kFace = 45.0;

// The paper's gear on the paper's machine with a wheel of 40 mm.
struct Grinding {
  InternalGear gear = paper_gear();
  WheelSetup setup = setup_for(gear, 40.0);
  MachineChain chain = grinder_chain();

  [[nodiscard]] double first_order(const FlankPlace& place, const ErrorSet& errors) const {
    const ContactInstant at = instant_of(gear, setup, place);
    return flank_deviation(at, left_error(chain, grinding_pose(gear, setup, at.stroke), errors));
  }

  template <class ErrorsAt>
  [[nodiscard]] double exact(const FlankPlace& place, const WheelProfile& profile,
                             const ErrorsAt& errors_at) const {
    double dn = 0.0;
    EXPECT_TRUE(exact_flank_deviation(chain, gear, setup, profile, instant_of(gear, setup, place),
                                      errors_at, dn)
                    .ok());
    return dn;
  }
};

ErrorSet single_error(std::size_t axis, int channel) {
  ErrorSet errors = zero_errors();
  errors[axis](channel) = channel < 3 ? 0.01 : 1e-4;
  return errors;
}

struct SensitivityCase {
  std::size_t axis;
  int channel;
  double dn;      // µm at the pitch radius, s = +1
  double parity;  // of s = −1: −1 odd, +1 even
  double prof;    // form circle minus tip, along the normal
  double lead;    // transverse, over the face
};

constexpr std::array<SensitivityCase, 24> kSection6{{
    {kGrinderC, 0, -3.24, 1, -1.38, 1.39},
    {kGrinderC, 1, -9.14, -1, 0.48, -0.49},
    {kGrinderC, 2, -2.43, -1, 0, 0},
    {kGrinderC, 3, 0.04, 1, -0.04, 4.53},
    {kGrinderC, 4, -1.99, -1, -0.10, -1.49},
    {kGrinderC, 5, 7.42, -1, 0, 0},
    {kGrinderX, 0, -3.25, 1, -1.42, 0},
    {kGrinderX, 1, -9.14, -1, 0.50, 0},
    {kGrinderX, 2, -2.43, -1, 0, 0},
    {kGrinderX, 3, 0.04, 1, -0.04, 4.24},
    {kGrinderX, 4, -1.99, -1, -0.10, -1.51},
    {kGrinderX, 5, 7.42, -1, 0, 0},
    {kGrinderZ, 0, 3.25, 1, 1.42, 0},
    {kGrinderZ, 1, 9.14, -1, -0.50, 0},
    {kGrinderZ, 2, 2.43, -1, 0, 0},
    {kGrinderZ, 3, -0.02, 1, 0.15, 0},
    {kGrinderZ, 4, 0.90, -1, 0.06, 0},
    {kGrinderZ, 5, -3.38, -1, -0.22, 0},
    {kGrinderA, 0, 3.25, 1, 1.42, 0},
    {kGrinderA, 1, 9.46, -1, -0.48, 0},
    {kGrinderA, 2, -0.02, -1, 0.13, 0},
    {kGrinderA, 3, -0.02, 1, 0.15, 0},
    {kGrinderA, 4, 0, 1, 0, 0},
    {kGrinderA, 5, -3.50, -1, -0.23, 0},
}};

// The figures of the profile are those along the normal, 3 % less than transverse; two of them
// (EYX, EYZ: 0.492) are rounded to 0.50.
TEST(FlankSensitivity, IsTheTableOfSection6) {
  constexpr double kPrinted = 0.006;  // two decimals
  constexpr double kProfilePrinted = 0.009;
  const Grinding g;
  const double tip = g.gear.r_tip;
  const double form = g.gear.r + g.gear.module;
  for (const SensitivityCase& row : kSection6) {
    SCOPED_TRACE(testing::Message() << "axis " << row.axis << ", channel " << row.channel);
    const ErrorSet errors = single_error(row.axis, row.channel);
    const auto um = [&](FlankSide side, double radius, double z) {
      return kUmPerMm * g.first_order({side, radius, z}, errors);
    };
    const double dn = um(FlankSide::left, g.gear.r, 0.0);
    SensitivityRows rows;
    ASSERT_TRUE(
        flank_sensitivity(g.chain, g.gear, g.setup, {FlankSide::left, g.gear.r, 0.0}, rows).ok());
    EXPECT_NEAR(kUmPerMm * rows[row.axis].dot(errors[row.axis]), dn, 1e-12);
    EXPECT_NEAR(dn, row.dn, kPrinted);
    EXPECT_NEAR(um(FlankSide::right, g.gear.r, 0.0), row.parity * dn, 1e-9);
    EXPECT_NEAR(um(FlankSide::left, form, 0.0) - um(FlankSide::left, tip, 0.0), row.prof,
                kProfilePrinted);
    const double lead =
        um(FlankSide::left, g.gear.r, 0.5 * kFace) - um(FlankSide::left, g.gear.r, -0.5 * kFace);
    EXPECT_NEAR(transverse_of(g.gear, lead), row.lead, kPrinted);
  }
}

TEST(FlankSensitivity, ConstantSwivelErrorHasNoLead) {
  const Grinding g;
  const ErrorSet errors = single_error(kGrinderA, 3);
  EXPECT_NEAR(g.first_order({FlankSide::left, g.gear.r, 20.0}, errors),
              g.first_order({FlankSide::left, g.gear.r, -20.0}, errors), 1e-15);
}

TEST(FlankFirstOrder, OfOneErrorIsWithinFiveNanometresOfTheEnvelope) {
  const Grinding g;
  double worst = 0.0;
  for (const FlankSide side : kBothSides) {
    const WheelProfile profile = profile_for(g.gear, g.setup, side, kWheelKnots);
    for (const SensitivityCase& row : kSection6) {
      const ErrorSet errors = single_error(row.axis, row.channel);
      for (const double radius : {g.gear.r_tip, g.gear.r, g.gear.r + g.gear.module}) {
        const FlankPlace place{side, radius, 11.0};
        const double exact =
            g.exact(place, profile, [&errors](const Pose&) -> const ErrorSet& { return errors; });
        worst = std::max(worst, std::abs(exact - g.first_order(place, errors)));
      }
    }
  }
  RecordProperty("worst_nm", std::to_string(worst * kNmPerMm));
  EXPECT_LE(worst * kNmPerMm, 5.0);
}

// 5 µm and 50 µrad rms in all 24 at once. 95 of 100 points lie within 10 nm, not all: what is left
// is second order, products of two errors, and its tail is as long as theirs.
TEST(FlankFirstOrder, OfAllErrorsStaysCloseToTheEnvelope) {
  constexpr int kTrials = 1000;
  const Grinding g;
  Random random;
  std::vector<double> off_nm;
  const WheelProfile left = profile_for(g.gear, g.setup, FlankSide::left, kWheelKnots);
  const WheelProfile right = profile_for(g.gear, g.setup, FlankSide::right, kWheelKnots);
  for (int i = 0; i < kTrials; ++i) {
    ErrorSet errors = zero_errors();
    for (std::size_t a = 0; a < 4; ++a) {
      for (Eigen::Index c = 0; c < 6; ++c)
        errors[a](c) = random.normal(c < 3 ? 0.005 : 50e-6);
    }
    const FlankPlace place{i % 2 == 0 ? FlankSide::left : FlankSide::right,
                           random.uniform(g.gear.r_tip, g.gear.r + g.gear.module),
                           random.uniform(-0.5 * kFace, 0.5 * kFace)};
    const double exact = g.exact(place, i % 2 == 0 ? left : right,
                                 [&errors](const Pose&) -> const ErrorSet& { return errors; });
    off_nm.push_back(kNmPerMm * std::abs(exact - g.first_order(place, errors)));
  }
  std::sort(off_nm.begin(), off_nm.end());
  const auto quantile = [&](double part) {
    return off_nm[static_cast<std::size_t>(part * (kTrials - 1))];
  };
  for (const double part : {0.5, 0.9, 0.95, 0.99, 1.0})
    RecordProperty("nm_at_" + std::to_string(part), std::to_string(quantile(part)));
  EXPECT_LE(quantile(0.5), 3.0);
  EXPECT_LE(quantile(0.95), 10.0);
}

// Halving all errors quarters the distance: it is of second order and nothing else.
TEST(FlankFirstOrder, MissesOnlyTheSecondOrder) {
  const Grinding g;
  const WheelProfile profile = profile_for(g.gear, g.setup, FlankSide::left, kWheelKnots);
  Random random;
  const FlankPlace place{FlankSide::left, g.gear.r, 5.0};
  for (int i = 0; i < 10; ++i) {
    ErrorSet errors = zero_errors();
    for (ErrorMotion& e : errors)
      e = random.error(0.02, 2e-4);
    const auto off = [&](double scale) {
      ErrorSet scaled = errors;
      for (ErrorMotion& e : scaled)
        e *= scale;
      return g.exact(place, profile, [&scaled](const Pose&) -> const ErrorSet& { return scaled; }) -
             g.first_order(place, scaled);
    };
    const double whole = off(1.0);
    EXPECT_NEAR(off(0.5), 0.25 * whole, 0.02 * std::abs(whole) + 2e-8);
  }
}

// Singly 3.25 (X), 41.35 (Z) and 42.76 µm (C); Z and C together 84.1 or 1.41 µm.
TEST(Synchronism, PrintedTrackingErrorsAreOneLagAlongTheHelix) {
  const Grinding g;
  const FlankPlace pitch{FlankSide::left, g.gear.r, 0.0};
  const auto um = [&](double e_x, double e_z, double e_c) {
    ErrorSet errors = zero_errors();
    errors[kGrinderX](0) = e_x;
    errors[kGrinderZ](2) = e_z;
    errors[kGrinderC](5) = e_c;
    return kUmPerMm * std::abs(g.first_order(pitch, errors));
  };
  const double c = 0.033 * kDegree;
  EXPECT_NEAR(um(0.01, 0, 0), 3.25, 0.005);
  EXPECT_NEAR(um(0, 0.17, 0), 41.35, 0.005);
  EXPECT_NEAR(um(0, 0, c), 42.76, 0.005);
  EXPECT_NEAR(um(0, 0.17, c), 84.1, 0.05);
  EXPECT_NEAR(um(0, -0.17, c), 1.41, 0.005);
  EXPECT_NEAR(kUmPerMm * synchronisation_on_flank(g.gear, synchronisation_error(g.gear, -0.17, c)),
              1.41, 0.005);
  EXPECT_NEAR(um(0, -g.gear.screw_parameter() * c, c), 0.0, 1e-9) << "a lag along the helix";
}

TEST(EnvelopeValidity, CurvatureAndLimitsOfSection5) {
  const Grinding g;
  double tip = 0.0;
  double form = 0.0;
  for (const FlankSide side : kBothSides) {
    ASSERT_TRUE(contact_curvature(g.gear, g.setup, side, g.gear.r_tip, tip).ok());
    ASSERT_TRUE(contact_curvature(g.gear, g.setup, side, g.gear.r + g.gear.module, form).ok());
    EXPECT_NEAR(tip, 0.0073, 0.0001);
    EXPECT_NEAR(form, 0.0102, 0.0001);
  }
  double kappa = 0.0;
  ASSERT_TRUE(contact_curvature(g.gear, g.setup, FlankSide::left, g.gear.r, kappa).ok());
  for (const auto& [wavelength, um] :
       {std::pair{1.0, 0.23}, std::pair{2.5, 1.4}, std::pair{5.0, 5.7}, std::pair{10.0, 23.0}})
    EXPECT_NEAR(kUmPerMm * first_order_limit(kappa, wavelength) / um, 1.0, 0.04) << wavelength;
  EXPECT_NEAR(kUmPerMm * most_waviness(kappa, 2.5), 7.0, 0.2);
}

// EYZ with 2.5 mm: below the limit the flank shows it in full, far beyond only κλ²/8 of it.
TEST(EnvelopeValidity, CrestsAreCutBeyondTheLimit) {
  constexpr double kWavelength = 2.5;
  const Grinding g;
  const WheelProfile profile = profile_for(g.gear, g.setup, FlankSide::left, kWheelKnots);
  double kappa = 0.0;
  ASSERT_TRUE(contact_curvature(g.gear, g.setup, FlankSide::left, g.gear.r, kappa).ok());
  const auto peak_to_valley = [&](double amplitude) {
    const auto errors_at = [&](const Pose& q) {
      ErrorSet errors = zero_errors();
      errors[kGrinderZ](1) = amplitude / 0.914 * std::sin(2.0 * kPi * q[kGrinderZ] / kWavelength);
      return errors;
    };
    double low = 1.0;
    double high = -1.0;
    for (int i = 0; i < 50; ++i) {
      const double dn =
          g.exact({FlankSide::left, g.gear.r, kWavelength * i / 50.0}, profile, errors_at);
      low = std::min(low, dn);
      high = std::max(high, dn);
    }
    return high - low;
  };
  const double limit = first_order_limit(kappa, kWavelength);
  EXPECT_NEAR(peak_to_valley(0.3 * limit), 0.6 * limit, 0.02 * limit);
  const double far_beyond = peak_to_valley(20.0 * limit);
  EXPECT_LT(far_beyond, 1.02 * most_waviness(kappa, kWavelength));
  EXPECT_GT(far_beyond, 0.8 * most_waviness(kappa, kWavelength));
}

TEST(EnvelopeValidity, LowerEnvelopeSaysWhenTheFirstOrderFails) {
  constexpr double kSpacing = 0.02;
  constexpr double kWavelength = 2.5;
  const Grinding g;
  double kappa = 0.0;
  ASSERT_TRUE(contact_curvature(g.gear, g.setup, FlankSide::left, g.gear.r, kappa).ok());
  const double limit = first_order_limit(kappa, kWavelength);
  const auto at_crest = [&](double amplitude) {
    std::vector<double> dn;
    for (int k = -150; k <= 150; ++k)
      dn.push_back(amplitude * std::cos(2.0 * kPi * k * kSpacing / kWavelength));
    return lower_envelope(kappa, {dn.data(), dn.size()}, kSpacing, 150, 1e-5);
  };
  EXPECT_TRUE(at_crest(0.9 * limit).first_order);
  EXPECT_NEAR(at_crest(0.9 * limit).dn, 0.9 * limit, 1e-12);
  EXPECT_FALSE(at_crest(2.0 * limit).first_order);
  // The next valley is half a wavelength away; the wheel reaches down to it.
  EXPECT_LT(at_crest(20.0 * limit).dn, -15.0 * limit);
}

TEST(FlankErrorRefusal, NoContactInsideTheBaseCircle) {
  const Grinding g;
  ContactInstant instant;
  EXPECT_EQ(contact_instant(g.gear, g.setup, {FlankSide::left, 70.0, 0.0}, instant).reason,
            Reason::inside_base_circle);
}

}  // namespace
}  // namespace volcomp::test
