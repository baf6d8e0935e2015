#include "host_sim/experiments/internal_helical/geometry_check.hpp"

#include <algorithm>
#include <cmath>

#include "comp/metrology/gears/contact_line.hpp"
#include "comp/metrology/gears/flank_envelope.hpp"
#include "host_sim/experiments/internal_helical/grinding.hpp"
#include "host_sim/experiments/internal_helical/grinding_job.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

constexpr std::size_t kGrinderAxes = 4;
constexpr Eigen::Index kLinearChannels = 3;

struct Grinder {
  explicit Grinder(const host::GrindingFile& job)
      : gear(job.gear), setup(form_wheel(job)), width_mm(job.width_mm) {}

  InternalGear gear;
  WheelSetup setup;
  double width_mm;
  MachineChain chain = helical_chain();

  [[nodiscard]] WheelProfile profile(FlankSide side, std::size_t knots) const {
    WheelProfile p;
    host::require(wheel_profile(gear, setup, side, gear.r_tip - 0.1 * gear.module,
                                gear.r + 1.1 * gear.module, knots, p),
                  "wheel profile");
    return p;
  }

  // Exact less first order, nm.
  [[nodiscard]] double miss(const FlankPlace& place, const WheelProfile& profile,
                            const ErrorSet& errors) const {
    ContactInstant at;
    host::require(contact_instant(gear, setup, place, at), "contact");
    const double first =
        flank_deviation(at, left_error(chain, grinding_pose(gear, setup, at.stroke), errors));
    double exact = 0.0;
    host::require(exact_flank_deviation(
                      chain, gear, setup, profile, at,
                      [&errors](const Pose&) -> const ErrorSet& { return errors; }, exact),
                  "envelope");
    return kNmPerMm * std::abs(exact - first);
  }
};

double regenerated(const Grinder& grinder, FlankSide side) {
  constexpr std::size_t kKnots = 17;
  constexpr int kPlaces = 100;
  const WheelProfile profile = grinder.profile(side, kKnots);
  double worst = 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double rho = profile.rho0 + (profile.last() - profile.rho0) * i / kPlaces;
    RegeneratedPoint point;
    host::require(regenerated_flank(grinder.gear, grinder.setup, side, profile, rho, point),
                  "wheel");
    worst = std::max(worst, kNmPerMm * std::abs(point.deviation));
  }
  return worst;
}

double single_errors(const Grinder& grinder, FlankSide side, const WheelProfile& profile) {
  constexpr double kHeight_mm = 11.0;
  double worst = 0.0;
  for (std::size_t axis = 0; axis < kGrinderAxes; ++axis) {
    for (Eigen::Index channel = 0; channel < 6; ++channel) {
      ErrorSet errors = zero_errors();
      errors[axis](channel) = channel < kLinearChannels ? 0.01 : 1e-4;
      for (const double radius :
           {grinder.gear.r_tip, grinder.gear.r, grinder.gear.r + grinder.gear.module})
        worst = std::max(worst, grinder.miss({side, radius, kHeight_mm}, profile, errors));
    }
  }
  return worst;
}

std::vector<double> many_errors(const Grinder& grinder, FlankSide side, const WheelProfile& profile,
                                sim::Random& random) {
  constexpr int kDraws = 100;
  std::vector<double> miss;
  for (int i = 0; i < kDraws; ++i) {
    ErrorSet errors = zero_errors();
    for (std::size_t axis = 0; axis < kGrinderAxes; ++axis) {
      for (Eigen::Index channel = 0; channel < 6; ++channel)
        errors[axis](channel) = random.normal(channel < kLinearChannels ? 5e-3 : 50e-6);
    }
    const double radius = random.uniform(grinder.gear.r_tip, grinder.gear.r + grinder.gear.module);
    const double z = grinder.width_mm * random.uniform(-0.5, 0.5);
    miss.push_back(grinder.miss({side, radius, z}, profile, errors));
  }
  return miss;
}

}  // namespace

GeometryCheck check_grinding_geometry(const host::GrindingFile& job) {
  const Grinder grinder(job);
  sim::Random random(1);
  GeometryCheck check;
  std::vector<double> all;
  for (const FlankSide side : kHelicalSides) {
    const WheelProfile exact = grinder.profile(side, kWheelKnots);
    check.regenerated_nm = std::max(check.regenerated_nm, regenerated(grinder, side));
    check.single_nm = std::max(check.single_nm, single_errors(grinder, side, exact));
    const std::vector<double> more = many_errors(grinder, side, exact, random);
    all.insert(all.end(), more.begin(), more.end());
  }
  std::sort(all.begin(), all.end());
  check.all_nm = all[all.size() * 95 / 100];
  return check;
}

}  // namespace volcomp::internal_helical
