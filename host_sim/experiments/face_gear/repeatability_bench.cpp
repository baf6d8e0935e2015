#include "host_sim/experiments/face_gear/repeatability_bench.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kBesideSurface_mm = 0.4;  // of the ball before a touch
constexpr double kBeyondSurface_mm = 0.4;  // as far as it may go without one
constexpr sim::ProbingFeeds kBenchFeeds{50.0, 5.0, 20.0};
constexpr std::uint32_t kBenchSetUps = 1'000'000;  // beyond those of all stations

}  // namespace

RepeatabilityBench::RepeatabilityBench(const FaceHall& hall)
    : hall_(hall), truth_(hall.truth), random_(sim::seed_of(hall.seed, sim::SeedOf::arm)) {
  auto axes =
      hall.make_axes(host::bus_settings(hall.file, hall.cycle_hz),
                     host::make_image(host::constant_tables(hall.file, zero_errors())->tables));
  axes_ = axes.get();
  axes_->controller().use_probe(host::node_probe(hall.file));
  cell_ = std::make_unique<sim::MotionCell>(truth_, std::move(axes));
  cell_->place(Pose{250.0, 0.0, 250.0, 0.0});
  prober_ = std::make_unique<sim::Prober>(*cell_, *axes_, hall_.file);
  deploy_arm();
}

void RepeatabilityBench::deploy_arm() {
  MachineDescription description = hall_.truth.chain.description();
  for (double& component : description.tool_point)
    component += kArmRepeatability_mm / std::sqrt(3.0) * random_.uniform(-1.0, 1.0);
  host::require(MachineChain::build(description, truth_.chain), hall_.file.path);
}

// The chain puts the centre of the ball at X, Y, Z.
double RepeatabilityBench::touch(const sim::Artefact& artefact, const StraightTouch& at) {
  const double radius = hall_.file.probe->radius_mm;
  const auto off = [&](double mm) -> Pose {
    const Vec3 ball = at.surface + (radius + mm) * at.normal;
    return {ball.x(), ball.y(), ball.z(), 0.0};
  };
  const Pose from = off(kBesideSurface_mm);
  sim::TouchProbe::Settings probe;
  probe.radius_mm = radius;
  probe.delay_ns = std::llround(1e3 * host::node_probe(hall_.file).delay_us);
  probe.scatter_mm = hall_.scatter.of_set_up(kBenchSetUps + set_ups_++);
  axes_->mount(sim::TouchProbe(truth_, nothing_, probe));
  cell_->move_to(from, kBenchFeeds.rapid);
  axes_->mount(sim::TouchProbe(truth_, artefact, probe));
  const sim::NodePoint point =
      prober_->touch(from, off(-kBeyondSurface_mm), Vec3::Zero(), kBenchFeeds);
  return kUmPerMm * ((point.workpiece - at.surface).dot(at.normal) - radius);
}

}  // namespace volcomp::face_gear
