#include "host_sim/experiments/self_calibration/bus_touches.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/bus/probe_setup.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/artefacts/sphere.hpp"
#include "host_sim/sim/controller/prober.hpp"

namespace volcomp::self_calibration {
namespace {

using namespace host::identify;

constexpr sim::ProbingFeeds kFeeds{50.0, 5.0, 20.0};
// From the place before a touch to where the tip travels between spheres. Only the sphere that is
// touched is simulated: others are not in the way.
constexpr double kClear_mm = 25.0;

MachineDescription with_tip(const MachineChain& chain, const Vec3& tip) {
  MachineDescription description = chain.description();
  description.tool_point = {tip.x(), tip.y(), tip.z()};
  return description;
}

// Tables of zeros: the node turns latches into points of the nominal machine.
std::vector<std::uint8_t> nominal_image(const host::MachineFile& machine, const Vec3& tip) {
  const auto built = host::constant_tables(machine, zero_errors());
  built->tables.machine = with_tip(machine.chain, tip);
  return host::make_image(built->tables);
}

// A machine with one stylus in the spindle, during one set-up.
class TouchingMachine {
 public:
  TouchingMachine(const MeasurementPlan& plan, const sim::PlanTruth& truth, const TouchingBus& bus,
                  std::size_t setup, std::size_t stylus)
      : plan_(plan),
        truth_(truth),
        machine_(plan.machine),
        true_(truth.setup[setup].machine),
        radius_(truth.tip_radius[stylus]) {
    const Vec3 tip = plan.problem.styli[stylus].offset;
    host::require(MachineChain::build(with_tip(plan.machine.chain, tip), nominal_), plan.path);
    host::require(MachineChain::build(with_tip(plan.machine.chain, truth.tip[stylus]), true_.chain),
                  plan.path);
    if (!machine_.probe) machine_.probe.emplace();
    machine_.probe->radius_mm = plan.problem.styli[stylus].radius;
    auto axes =
        bus.make_axes(host::bus_settings(machine_, bus.cycle_hz), nominal_image(plan.machine, tip));
    axes_ = axes.get();
    axes_->controller().use_probe(host::node_probe(machine_));
    cell_ = std::make_unique<sim::MotionCell>(true_, std::move(axes));
  }

  // The touches of one sphere; `first`: number of the first of them in its set-up.
  void touch(const std::vector<TouchMove>& moves, std::size_t first, std::size_t count,
             std::vector<LatchedTouch>& out) {
    const TouchMove& pole = moves[first];
    // Moves to the place of the pole, away from all spheres; the probe is mounted there.
    go_clear(pole);
    mount(pole, first);
    for (std::size_t i = first; i < first + count; ++i) {
      if (i > first) go(corner(moves[i - 1], moves[i]));
      arrive(moves[i].from);
      arrive(moves[i].beyond);
      const sim::NodePoint point =
          prober().touch(moves[i].from, moves[i].beyond, Vec3::Zero(), kFeeds);
      require_nominal(point, moves[i]);
      out.push_back({moves[i].setup, moves[i].sphere, moves[i].stylus, point.latched, directions_});
      arrive(moves[i].from);
    }
    // Back over the pole.
    go(corner(moves[first + count - 1], pole));
    go(pole.from);
    go_away(pole);
  }

 private:
  sim::Prober& prober() {
    if (!prober_) prober_ = std::make_unique<sim::Prober>(*cell_, *axes_, machine_);
    return *prober_;
  }

  void arrive(const Pose& to) {
    arrive_at(at_, to, directions_);
    at_ = to;
  }
  void go(const Pose& to) {
    cell_->move_to(to, kFeeds.rapid);
    arrive(to);
  }

  [[nodiscard]] Pose within_travel(Pose q) const {
    for (std::size_t a = 0; a < machine_.axes.size(); ++a)
      q.at(a) = std::clamp(q.at(a), machine_.axes[a].lo, machine_.axes[a].hi);
    return q;
  }
  // Farther along the way on which a touch retracts.
  [[nodiscard]] Pose away(const TouchMove& move) const {
    Pose q = move.from;
    const double part = kClear_mm / (kClearance_mm + kOvertravel_mm);
    for (std::size_t a = 0; a < kMaxAxes; ++a)
      q.at(a) += part * (move.from.at(a) - move.beyond.at(a));
    return within_travel(q);
  }
  // Past two neighbouring places of a sphere: the fourth corner of the square with its centre.
  [[nodiscard]] Pose corner(const TouchMove& before, const TouchMove& after) const {
    const Artefact& artefact =
        plan_.problem.artefacts[*plan_.problem.setups[before.setup].artefact];
    const double contact =
        artefact.radius[before.sphere] + plan_.problem.styli[before.stylus].radius;
    const double part = (contact + kClearance_mm) / (kClearance_mm + kOvertravel_mm);
    Pose q = after.from;
    for (std::size_t a = 0; a < kMaxAxes; ++a)
      q.at(a) += part * (before.from.at(a) - before.beyond.at(a));
    return within_travel(q);
  }

  void go_clear(const TouchMove& pole) {
    if (!placed_) {
      cell_->place(away(pole));
      at_ = away(pole);
      placed_ = true;
    }
    go(away(pole));
    go(pole.from);
  }
  void go_away(const TouchMove& pole) { go(away(pole)); }

  void mount(const TouchMove& move, std::size_t first) {
    const sim::TrueSetUp& t = truth_.setup[move.setup];
    const std::size_t artefact = *plan_.problem.setups[move.setup].artefact;
    sphere_ =
        std::make_unique<sim::Sphere>(t.pose.R * truth_.sphere[artefact][move.sphere] + t.pose.t,
                                      plan_.problem.artefacts[artefact].radius[move.sphere]);
    sim::TouchProbe::Settings settings;
    settings.radius_mm = radius_;
    settings.delay_ns = std::llround(1e3 * machine_.probe->delay_us);
    settings.scatter_mm = [this, setup = move.setup, first](std::uint32_t touch) {
      return sim::scatter_of_touch(plan_, truth_, setup, static_cast<std::uint32_t>(first) + touch);
    };
    axes_->mount(sim::TouchProbe(true_, *sphere_, settings));
  }

  // The point of the node is the centre of the ball on the nominal machine.
  void require_nominal(const sim::NodePoint& point, const TouchMove& move) const {
    constexpr double kSame_mm = 1e-4;
    const Vec3 nominal = ideal_points(nominal_, point.latched, nominal_.tool_point()).work;
    if ((point.workpiece - nominal).norm() < kSame_mm) return;
    throw host::UserError(
        fmt::format("set-up \"{}\", sphere {}: the point of the node is {:.1f} um from where the "
                    "nominal machine stands at the latches",
                    plan_.problem.setups[move.setup].name, move.sphere,
                    kUmPerMm * (point.workpiece - nominal).norm()));
  }

  const MeasurementPlan& plan_;
  const sim::PlanTruth& truth_;
  host::MachineFile machine_;
  sim::TrueMachine true_;
  MachineChain nominal_;
  double radius_;
  sim::BusAxes* axes_ = nullptr;
  std::unique_ptr<sim::MotionCell> cell_;
  std::unique_ptr<sim::Prober> prober_;
  std::unique_ptr<sim::Sphere> sphere_;
  Pose at_{};
  Directions directions_{};
  bool placed_ = false;
};

}  // namespace

std::vector<LatchedTouch> touch_on_bus(const MeasurementPlan& plan, const sim::PlanTruth& truth,
                                       const TouchingBus& bus, const host::Progress& progress) {
  std::vector<LatchedTouch> touches;
  const std::size_t setups = plan.problem.setups.size();
  for (std::size_t k = 0; k < setups; ++k) {
    if (!plan.problem.setups[k].has_pose()) continue;
    const std::vector<TouchMove> moves = touch_moves(plan, k);
    std::unique_ptr<TouchingMachine> machine;
    std::size_t stylus = 0;
    for (std::size_t i = 0; i + kTouchesOfSphere <= moves.size(); i += kTouchesOfSphere) {
      progress(
          (static_cast<double>(k) + static_cast<double>(i) / static_cast<double>(moves.size())) /
              static_cast<double>(setups),
          fmt::format("touching: {}", plan.problem.setups[k].name));
      if (!machine || moves[i].stylus != stylus) {
        stylus = moves[i].stylus;
        machine.reset();
        machine = std::make_unique<TouchingMachine>(plan, truth, bus, k, stylus);
      }
      machine->touch(moves, i, kTouchesOfSphere, touches);
    }
  }
  return touches;
}

}  // namespace volcomp::self_calibration
