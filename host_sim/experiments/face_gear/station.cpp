#include "host_sim/experiments/face_gear/station.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::face_gear {
namespace {

constexpr std::uint32_t kDeployments = 1000;  // more than any station sees
constexpr sim::ProbingFeeds kFeeds{50.0, 5.0, 20.0};

// The slides X, Y, Z lie along the axes of base.
Vec3 along(const Pose& from, const Pose& to) {
  return Vec3(to[0] - from[0], to[1] - from[1], to[2] - from[2]).normalized();
}

}  // namespace

double FaceScatter::sigma_mm() const {
  return std::hypot(probe.noise.sigma(), slide_step_mm / std::sqrt(12.0));
}

std::function<double(std::uint32_t)> FaceScatter::of_set_up(std::uint32_t set_up) const {
  if (!(sigma_mm() > 0.0)) return {};
  return [scatter = *this, set_up](std::uint32_t touch) {
    const auto index = [&](RandomStream stream) {
      return RandomIndex{static_cast<std::uint32_t>(stream), 0, set_up, touch};
    };
    const double in_step = uniforms(scatter.seed, index(RandomStream::repeatability)).u - 0.5;
    return scatter.probe.noise.sigma() * normal(scatter.seed, index(RandomStream::probe)) +
           scatter.slide_step_mm * in_step;
  };
}

FaceStation::FaceStation(const FaceHall& hall, const MachineTables& tables, const Frame& believed,
                         std::uint32_t placement)
    : hall_(hall),
      truth_(hall.truth),
      gear_(hall.gear, hall.mounting, hall.errors),
      random_(sim::seed_of(hall.seed, sim::SeedOf::arm)),
      believed_(believed),
      placement_(placement) {
  host::require(MachineChain::build(tables.machine, chain_), hall.file.path);
  auto axes =
      hall.make_axes(host::bus_settings(hall.file, hall.cycle_hz), host::make_image(tables));
  axes_ = axes.get();
  axes_->controller().use_probe(host::node_probe(hall.file));
  cell_ = std::make_unique<sim::MotionCell>(truth_, std::move(axes));
  last_ = path().above_tips({});
  cell_->place(last_);
  prober_ = std::make_unique<sim::Prober>(*cell_, *axes_, hall.file);
  deploy_arm();
  believe(believed);
}

void FaceStation::deploy_arm() {
  MachineDescription description = hall_.truth.chain.description();
  for (double& component : description.tool_point)
    component += kArmRepeatability_mm / std::sqrt(3.0) * random_.uniform(-1.0, 1.0);
  host::require(MachineChain::build(description, truth_.chain), hall_.file.path);
  sim::TouchProbe::Settings probe;
  const host::NodeProbe described = host::node_probe(hall_.file);
  probe.radius_mm = described.radius.coefficient[0];
  probe.delay_ns = std::llround(1e3 * described.delay_us);
  ++deployments_;
  if (hall_.radius) hall_.scatter.probe.give_to(probe);
  probe.scatter_mm = hall_.scatter.of_set_up(kDeployments * placement_ + deployments_);
  axes_->mount(sim::TouchProbe(truth_, gear_, probe));
}

void FaceStation::believe(const Frame& mounting) {
  believed_ = mounting;
  host::NodeProbe probe = host::node_probe(hall_.file);
  probe.workpiece = mounting;
  probe.gear_id = kGearId;
  probe.gear = hall_.gear;
  prober_->configure(probe);
}

// The scale does not resolve the true position of the table.
void FaceStation::arrive_at(int slot) {
  table_ = path().table_at(slot);
  gear_.turn_table(random_.uniform(-0.5, 0.5) * kScaleStep_rad);
}

double FaceStation::effective_radius(const Pose& at, const Vec3& normal) const {
  if (!hall_.radius) return hall_.file.probe->radius_mm;
  return hall_.radius->radius(chain_.ideal(chain_.tool(), at).R.transpose() * normal);
}

void FaceStation::retract() {
  if (clear_) return;
  last_ = path().above_tips(last_);
  cell_->move_to(last_, kFeeds.rapid);
  clear_ = true;
}

// Over the slot, then down; along the flank where the ball is already there.
void FaceStation::approach(const FlankName& flank, const Pose& from) {
  if (!clear_) return;
  cell_->move_to(path().above_tips(from), kFeeds.rapid);
  clear_ = false;
  last_flank_ = flank;
}

FaceStationTouch FaceStation::touch(const FlankName& flank, const SurfacePoint& at, std::size_t row,
                                    std::size_t column, TouchFrom away) {
  if (flank.slot != last_flank_.slot || flank.side != last_flank_.side) {
    retract();
    if (flank.slot != last_flank_.slot) arrive_at(flank.slot);
  }
  const double radius = hall_.file.probe->radius_mm;
  const FacePath way = path();
  const auto off = [&](double mm) { return way.ball_at(flank, at, mm, table_); };
  const Vec3 normal = along(off(0.0), off(1.0));
  const double effective = effective_radius(off(radius), normal);
  const Pose from = off(radius + (away == TouchFrom::beside ? kStandOff_mm : kAgain_mm));
  approach(flank, from);
  const sim::FlankFeature feature{kGearId, flank.side, flank.slot, row,
                                  column,  effective,  kGate_mm};
  const sim::NodePoint point = prober_->touch(from, off(radius - kOverTravel_mm), feature, kFeeds);
  last_ = from;
  const Mat3 from_base = (chain_.ideal(chain_.work(), from) * believed_).R.transpose();
  return {point.workpiece, point.flank, effective, from_base * normal};
}

}  // namespace volcomp::face_gear
