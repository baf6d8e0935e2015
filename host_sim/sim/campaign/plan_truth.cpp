#include "host_sim/sim/campaign/plan_truth.hpp"

#include <cmath>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"

namespace volcomp::sim {
namespace {

namespace identify = host::identify;

// One sequence of numbers for each set-up, and one for what they share.
class Draws {
 public:
  Draws(const ShopFloor& floor, RandomStream stream, std::uint32_t setup)
      : floor_(floor), stream_(stream), setup_(setup) {}

  double next(double sigma) {
    return sigma * normal(floor_.seed,
                          {static_cast<std::uint32_t>(stream_), floor_.draw, setup_, number_++});
  }
  Vec3 next3(double sigma) {
    Vec3 v;
    for (Eigen::Index k = 0; k < 3; ++k)
      v(k) = next(sigma);
    return v;
  }

 private:
  const ShopFloor& floor_;
  RandomStream stream_;
  std::uint32_t setup_;
  std::uint32_t number_ = 0;
};

// Finite standard deviations only: what is free has none.
double stated(const identify::Prior& prior) {
  return prior && *prior < identify::kFree ? *prior : 0.0;
}

void draw_styli(const identify::Problem& problem, const ShopFloor& floor, Draws& draws,
                PlanTruth& out) {
  for (const identify::Stylus& stylus : problem.styli) {
    const Vec3 off = draws.next3(floor.stylus_mm);
    const double larger = draws.next(stated(stylus.radius_prior));
    out.tip.emplace_back(stylus.place ? Vec3(stylus.offset + off) : stylus.offset);
    out.tip_radius.push_back(stylus.radius + larger);
  }
}

void draw_artefacts(const identify::Problem& problem, const ShopFloor& floor, Draws& draws,
                    PlanTruth& out) {
  const double share = floor.perfect ? 0.0 : 1.0;
  for (const identify::Artefact& artefact : problem.artefacts) {
    double longer = 1.0 + share * draws.next(stated(artefact.scale));
    // One that is not calibrated is as large as its known length says.
    if (!artefact.lengths.empty()) {
      const identify::Length& known = artefact.lengths.front();
      const double nominal = (artefact.spheres[known.b] - artefact.spheres[known.a]).norm();
      if (artefact.place == identify::kFree && nominal > 0.0)
        longer = (known.length + share * draws.next(known.sigma)) / nominal;
    }
    std::vector<Vec3> spheres;
    for (const Vec3& sphere : artefact.spheres)
      spheres.emplace_back(longer * (sphere + share * draws.next3(stated(artefact.place))));
    out.sphere.push_back(std::move(spheres));
  }
}

TrueSetUp draw_setup(const identify::SetUp& s, const TrueMachine& machine, const ShopFloor& floor,
                     Draws& warmth, Draws& draws) {
  TrueSetUp t;
  t.machine = machine;
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a) {
    const double warmer = warmth.next(floor.growth_K);
    if (!floor.perfect && machine.chain.axis(a).kind == JointKind::prismatic)
      t.machine.warmer_K.at(a) += warmer;
  }
  // The scale of a placement is that of the machine, which has grown.
  const double longer = draws.next(stated(s.scale));
  if (!floor.perfect && !s.has_pose()) t.kappa = longer;
  const Vec3 way = draws.next3(floor.pose_mm);
  const Vec3 turn = draws.next3(floor.pose_rad);
  if (s.pose) t.pose = {identify::exponential(turn) * s.pose->R, s.pose->t + way};
  const Vec3 aside = draws.next3(floor.station_mm);
  if (s.station) t.station = *s.station + aside;
  if (s.station && s.station_prior)
    t.station =
        *s.station + (floor.perfect ? 0.0 : stated(s.station_prior) / floor.station_mm) * aside;
  // A bar sees nothing of its socket along the normal of the circle, and little else is free.
  constexpr double kSocket = 0.02;
  if (s.kind == identify::ObservationKind::bar)
    t.station = *s.station + kSocket * (aside - s.normal * s.normal.dot(aside));
  if (s.kind == identify::ObservationKind::rtest) t.station = 0.1 * aside;  // from the first place
  t.dead_length = draws.next(floor.dead_length_mm);
  if (s.kind == identify::ObservationKind::bar)
    t.dead_length = s.length_prior && *s.length_prior < identify::kFree
                        ? draws.next(*s.length_prior)
                        : 0.01 * t.dead_length;
  if (s.mirror) t.mirror = identify::exponential(draws.next3(floor.mirror_rad)) * *s.mirror;
  for (Eigen::Index c = 0; c < 6; ++c)
    t.zero(c) = draws.next(c < 3 ? 0.01 : 1e-5);
  return t;
}

}  // namespace

double tracer_drift_mm(const ShopFloor& floor, std::size_t places) {
  constexpr double kHour_s = 3600.0;
  const double hours = floor.dwell_s * static_cast<double>(places) / kHour_s;
  return floor.drift_mm * std::sqrt(hours / 6.0);
}

PlanTruth draw_plan_truth(const identify::Problem& problem, const TrueMachine& machine,
                          const ShopFloor& floor) {
  PlanTruth out;
  out.floor = floor;
  Draws styli(floor, RandomStream::set_up, kCommon);
  draw_styli(problem, floor, styli, out);
  Draws artefacts(floor, RandomStream::set_up, kCommon - 1);
  draw_artefacts(problem, floor, artefacts, out);
  for (std::size_t k = 0; k < problem.setups.size(); ++k) {
    const auto number = static_cast<std::uint32_t>(k);
    Draws warmth(floor, RandomStream::temperature, number);
    Draws draws(floor, RandomStream::set_up, number);
    out.setup.push_back(draw_setup(problem.setups[k], machine, floor, warmth, draws));
  }
  return out;
}

}  // namespace volcomp::sim
