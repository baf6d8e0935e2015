#pragma once
// The L300G on its bus: axes, node with tables, probe, and whatever artefact stands on A.

#include <functional>
#include <memory>

#include "comp/metrology/gears/l300g.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/experiments/l300g/truth.hpp"
#include "host_sim/sim/controller/prober.hpp"
#include "host_sim/sim/instruments/probe_signature.hpp"

namespace volcomp::l300g {

// What of the chain the paths of the probe need.
struct GrinderGeometry {
  SwingArm arm;
  L300gDatum datum;
};
[[nodiscard]] GrinderGeometry grinder_geometry(const MachineChain& chain);

// The same machine with the axis of A where the probe has found it, mm.
[[nodiscard]] MachineDescription with_origin(const MachineChain& chain, double y0, double z0);

// What the touches of a probe do, none by default, and which random numbers they take.
struct ProbeScatter {
  sim::ProbeSignature probe;
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;  // one of several measurements of everything
};

// What is touched, for the random numbers: a new one gets a new number.
enum class Mounted : std::uint32_t {
  mandrel = 0,
  gear_before = 1,
  gear_after = 2,
  sphere = 3,
  mandrel_before = 4,
  mandrel_after = 5,
};

// What all grinders of a run share; outlives them.
struct GrinderHall {
  host::MachineFile file;
  sim::TrueMachine truth;
  sim::BusAxesFactory make_axes;
  double cycle_hz = sim::kBusCycleOfFive_hz;
  ProbeScatter scatter{};
};

// From the axis of A: beyond everything that may stand there.
inline constexpr double kFarAway_mm = 100.0;

class Grinder {
 public:
  Grinder(const GrinderHall& hall, const MachineTables& tables);

  // What stands on A from now on; it must outlive the touches. Only while the probe is clear of it.
  // `lobing_mm`: what the direction of a touch adds to the radius of the ball (touch_probe.hpp).
  void mount(const sim::Artefact& artefact, Mounted as,
             std::function<double(const Vec3&)> lobing_mm = {});
  [[nodiscard]] sim::Prober& prober() { return *prober_; }
  // Without touching.
  void go(const Pose& to, double feed) { cell_->move_to(to, feed); }

  // The machine as the node models it.
  [[nodiscard]] const MachineChain& chain() const { return chain_; }
  [[nodiscard]] const GrinderGeometry& geometry() const { return geometry_; }
  // Level arm, so far from the axis of A.
  [[nodiscard]] Pose clear_of_work(double away_mm) const;

 private:
  const GrinderHall& hall_;
  MachineChain chain_;
  GrinderGeometry geometry_;
  sim::BusAxes* axes_ = nullptr;
  std::unique_ptr<sim::MotionCell> cell_;
  std::unique_ptr<sim::Prober> prober_;
};

}  // namespace volcomp::l300g
