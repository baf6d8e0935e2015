#include "host_sim/experiments/face_gear/station.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kStandOff_mm = 0.4;    // of the ball before a touch
constexpr double kOverTravel_mm = 0.4;  // as far as it may go without one
constexpr double kAboveTips_mm = 8.0;
constexpr sim::ProbingFeeds kFeeds{50.0, 5.0, 20.0};

Vec3 in_slot(const FaceGear& gear, const FlankName& flank, const Vec3& v) {
  const double angle = 2.0 * kPi * flank.slot / gear.teeth;
  const Vec3 mirrored(v.x(), flank.side * v.y(), v.z());
  return axis_rotation(Axis::z, angle) * mirrored;
}

}  // namespace

FaceStation::FaceStation(const FaceHall& hall, const MachineTables& tables, const Frame& believed)
    : hall_(hall),
      truth_(hall.truth),
      gear_(hall.gear, hall.mounting, hall.errors),
      random_(hall.seed),
      believed_(believed) {
  host::require(MachineChain::build(tables.machine, chain_), hall.file.path);
  auto axes =
      hall.make_axes(host::bus_settings(hall.file, hall.cycle_hz), host::make_image(tables));
  axes_ = axes.get();
  axes_->controller().use_probe(host::node_probe(hall.file));
  cell_ = std::make_unique<sim::MotionCell>(truth_, std::move(axes));
  last_ = pose_at({hall.gear.r_pitch, 0.0, hall.gear.z_tip - kAboveTips_mm});
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
  axes_->mount(sim::TouchProbe(truth_, gear_, probe));
  ++deployments_;
}

void FaceStation::believe(const Frame& mounting) {
  believed_ = mounting;
  host::NodeProbe probe = host::node_probe(hall_.file);
  probe.workpiece = mounting;
  probe.gear_id = kGearId;
  probe.gear = hall_.gear;
  prober_->configure(probe);
}

// The slides are parallel to the axes of base.
Pose FaceStation::pose_at(const Vec3& in_gear) const {
  Pose at_zero{};
  at_zero[3] = table_;
  const Vec3 from = ideal_points(chain_, at_zero, chain_.tool_point()).work;
  const Vec3 way = axis_rotation(Axis::z, table_) * (believed_.apply(in_gear) - from);
  return {way.x(), way.y(), way.z(), table_};
}

// Turns to the nearest line of the scale; the scale does not resolve the true position of the
// table.
void FaceStation::turn_to(int slot) {
  const Vec3 centre =
      believed_.R * axis_rotation(Axis::z, 2.0 * kPi * slot / hall_.gear.teeth) * Vec3::UnitX();
  const double wanted = -std::atan2(centre.y(), centre.x());
  const double whole = 2.0 * kPi;
  const double steps = std::round((wanted - whole * std::floor(wanted / whole)) / kScaleStep_rad);
  table_ = steps * kScaleStep_rad;
  gear_.turn_table(random_.uniform(-0.5, 0.5) * kScaleStep_rad);
}

Pose FaceStation::above_tips(Pose at) const {
  at[2] = pose_at({hall_.gear.r_pitch, 0.0, hall_.gear.z_tip - kAboveTips_mm})[2];
  return at;
}

void FaceStation::retract() {
  if (clear_) return;
  last_ = above_tips(last_);
  cell_->move_to(last_, kFeeds.rapid);
  clear_ = true;
}

// Over the slot, then down; along the flank where the ball is already there.
void FaceStation::approach(const FlankName& flank, const Pose& from) {
  if (!clear_) return;
  cell_->move_to(above_tips(from), kFeeds.rapid);
  clear_ = false;
  last_flank_ = flank;
}

FaceStationTouch FaceStation::touch(const FlankName& flank, const SurfacePoint& at, std::size_t row,
                                    std::size_t column) {
  if (flank.slot != last_flank_.slot || flank.side != last_flank_.side) {
    retract();
    if (flank.slot != last_flank_.slot) turn_to(flank.slot);
  }
  const double radius = hall_.file.probe->radius_mm;
  const auto off = [&](double mm) {
    return pose_at(in_slot(hall_.gear, flank, at.point + mm * at.normal));
  };
  const Pose from = off(radius + kStandOff_mm);
  approach(flank, from);
  const sim::FlankFeature feature{kGearId, flank.side, flank.slot, row, column, radius, kGate_mm};
  const sim::NodePoint point = prober_->touch(from, off(radius - kOverTravel_mm), feature, kFeeds);
  last_ = from;
  return {point.workpiece, point.flank};
}

}  // namespace volcomp::face_gear
