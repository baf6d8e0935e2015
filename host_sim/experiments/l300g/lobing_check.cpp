#include "host_sim/experiments/l300g/lobing_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "comp/core/units.hpp"
#include "comp/metrology/fits/lobing_fit.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/artefacts/sphere.hpp"

namespace volcomp::l300g {
namespace {

constexpr double kSphere_mm = 15.0;
constexpr double kLobing_mm = 5e-3;
constexpr double kNoise_mm = 0.1e-3;
constexpr double kAway_mm = 5.0;  // so that the way to the next direction is clear of the sphere
constexpr double kBeyond_mm = 0.3;
constexpr double kRadPerDegree = kPi / 180.0;
constexpr int kAround = 9;  // directions of a ring: third order needs seven
constexpr sim::ProbingFeeds kFeeds{50.0, 10.0, 50.0};

using Rings = std::array<double, 4>;  // elevations, degrees; third order needs four
constexpr Rings kMapped{-60.0, -20.0, 20.0, 60.0};
constexpr Rings kChecked{45.0, 10.0, -10.0, -45.0};
constexpr Rings kCheckedAgain{-45.0, -10.0, 10.0, 45.0};

// To and fro, so that the last one of a ring is next to the first one of the next.
std::vector<Vec3> directions(const Rings& elevations, double turned_deg) {
  std::vector<Vec3> all;
  bool back = false;
  for (const double elevation : elevations) {
    for (int i = 0; i < kAround; ++i) {
      const int step = back ? kAround - 1 - i : i;
      const double azimuth = (turned_deg + 360.0 / kAround * step) * kRadPerDegree;
      const double level = std::cos(elevation * kRadPerDegree);
      all.emplace_back(level * std::sin(azimuth), level * std::cos(azimuth),
                       std::sin(elevation * kRadPerDegree));
    }
    back = !back;
  }
  return all;
}

// Largest in any direction: on a grid of 5°.
double largest(const LobingMap& map) {
  double most = 0.0;
  for (int e = -90; e <= 90; e += 5) {
    for (int a = 0; a < 360; a += 5) {
      const double level = std::cos(e * kRadPerDegree);
      const Vec3 d(level * std::cos(a * kRadPerDegree), level * std::sin(a * kRadPerDegree),
                   std::sin(e * kRadPerDegree));
      most = std::max(most, std::abs(map.radius(d)));
    }
  }
  return most;
}

LobingMap drawn(sim::Random& random) {
  LobingMap map;
  for (std::size_t k = 1; k < kLobingTerms; ++k)
    map.coefficient[k] = random.uniform(-1.0, 1.0);
  const double scale = kLobing_mm / largest(map);
  for (double& c : map.coefficient)
    c *= scale;
  return map;
}

class SphereBench {
 public:
  SphereBench(const GrinderHall& hall, const MachineTables& tables, const LobingMap& truth)
      : file_(hall.file), grinder_(hall, tables) {
    grinder_.mount(sphere_, Mounted::sphere, [truth](const Vec3& d) { return truth.radius(d); });
  }

  // The radius that the probe has shown in each direction of the tool frame.
  LobingMap map(sim::Random& noise) {
    use(host::node_probe(file_).radius);
    std::vector<Vec3> direction;
    std::vector<double> radius;
    for (const Vec3& n : directions(kMapped, 0.0)) {
      const sim::NodePoint centre = touch(n, Vec3::Zero());
      direction.push_back(in_tool(centre));
      radius.push_back(centre.workpiece.norm() - kSphere_mm + noise.normal(kNoise_mm));
    }
    LobingFit fit;
    host::require(fit_lobing(direction, radius, fit), "lobing");
    return fit.map;
  }

  // Largest distance of a point from the sphere.
  double worst_um(const LobingMap& radius, const Rings& rings) {
    use(radius);
    double worst = 0.0;
    for (const Vec3& n : directions(rings, 20.0))
      worst = std::max(worst, std::abs(touch(n, n).workpiece.norm() - kSphere_mm));
    return kUmPerMm * worst;
  }

 private:
  void use(const LobingMap& radius) {
    host::NodeProbe probe = host::node_probe(file_);
    probe.radius = radius;
    grinder_.prober().configure(probe);
  }

  [[nodiscard]] Pose pose_at(const Vec3& centre) const {
    const GrinderGeometry& g = grinder_.geometry();
    Pose q{};
    host::require(arm_angle(g.arm, centre.z(), q[2]), "sphere");
    q[0] = g.datum.x + centre.x() - arm_foreshortening(g.arm, q[2]);
    q[1] = g.datum.y + centre.y();
    return q;
  }

  sim::NodePoint touch(const Vec3& from_side, const Vec3& normal) {
    const double touching = kSphere_mm + host::node_probe(file_).radius.coefficient[0];
    return grinder_.prober().touch(pose_at(from_side * (touching + kAway_mm)),
                                   pose_at(from_side * (touching - kBeyond_mm)), normal, kFeeds);
  }

  [[nodiscard]] Vec3 in_tool(const sim::NodePoint& centre) const {
    const MachineChain& chain = grinder_.chain();
    const Vec3 in_base = chain.ideal(chain.work(), centre.latched).R * centre.workpiece;
    return (chain.ideal(chain.tool(), centre.latched).R.transpose() * in_base).normalized();
  }

  const host::MachineFile& file_;
  sim::Sphere sphere_{Vec3::Zero(), kSphere_mm};
  Grinder grinder_;
};

}  // namespace

LobingCheck check_lobing(const host::MachineFile& file, const sim::BusAxesFactory& make_axes,
                         double cycle_hz, std::uint64_t seed) {
  const GrinderHall hall{file, make_l300g_truth(file, {}, seed), make_axes, cycle_hz};
  const MachineTables tables = host::constant_tables(file, zero_errors())->tables;
  sim::Random random(seed);
  SphereBench bench(hall, tables, drawn(random));
  const LobingMap map = bench.map(random);
  LobingMap constant;
  constant.coefficient[0] = map.coefficient[0];
  LobingCheck check;
  check.raw_um = bench.worst_um(constant, kChecked);
  check.corrected_um = bench.worst_um(map, kCheckedAgain);
  return check;
}

}  // namespace volcomp::l300g
