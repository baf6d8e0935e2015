#pragma once
// Touch trigger probe at the tool point of a machine: its signal rises when the ball comes as near
// to the artefact as it takes to trip the probe, and falls when it leaves.

#include <cstdint>
#include <functional>
#include <vector>

#include "host_sim/sim/artefacts/artefact.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Where the encoders of all axes stand, and from where they came.
struct Stance {
  Pose position{};
  Approach approach{};
};

struct ProbeEdge {
  bool rising = true;
  std::int64_t time_ns = 0;  // since the begin of the period of the call
};

class TouchProbe {
 public:
  struct Settings {
    // Effective radius r_c: of the ball, less the mean of the pre-travel.
    double radius_mm = 0.0;
    // What a direction adds to it; empty: nothing. `normal`: outward normal of the part at the
    // contact, unit, in the tool frame.
    std::function<double(const Vec3& normal)> lobing_mm;
    std::int64_t delay_ns = 10'000;  // of the electronics, from trip to edge
    // The contacts bounce: so long after the edge the signal rises once more, having fallen halfway
    // since it last rose. In order.
    std::vector<std::int64_t> bounces_ns;
    // What each touch adds besides, by its number from 0: positive trips early, as excess material
    // would; empty: nothing.
    std::function<double(std::uint32_t touch)> scatter_mm = {};
    // Between touches from opposite sides: half of it, positive where the touch before came from
    // the same side, by the cosine between the two normals; the first one has none.
    double hysteresis_mm = 0.0;
  };

  // Machine and artefact must outlive the probe.
  TouchProbe(const TrueMachine& machine, const Artefact& artefact, Settings settings);

  // All axes go evenly from one stance to the next, in turn: `from` is where the last call ended.
  // What comes out of the probe meanwhile, edges delayed from earlier included. Instants of contact
  // are exact to 1 ns. A contact that begins and ends within one call passes unnoticed.
  [[nodiscard]] std::vector<ProbeEdge> travel(const Stance& from, const Stance& to,
                                              std::int64_t period_ns);

  // Centre of the ball where it really is: work frame, mm.
  [[nodiscard]] Vec3 ball_centre(const Stance& at) const;
  // How far the ball may still go towards the artefact until the probe trips, mm.
  [[nodiscard]] double margin_mm(const Stance& at) const;

 private:
  [[nodiscard]] std::int64_t crossing_ns(const Stance& from, const Stance& to,
                                         std::int64_t period_ns) const;
  void touched(std::int64_t time_ns);
  [[nodiscard]] std::vector<ProbeEdge> due(std::int64_t period_ns);
  void draw_scatter();
  [[nodiscard]] Vec3 in_tool(const Stance& at, const Vec3& normal) const;

  const TrueMachine& machine_;
  const Artefact& artefact_;
  Settings settings_;
  std::vector<ProbeEdge> coming_;  // out of the electronics, in order
  bool seen_ = false;              // tripped_ is valid
  bool tripped_ = false;
  std::uint32_t touch_ = 0;       // the next or present one
  double scatter_ = 0.0;          // mm, of it; of the last one until the ball is clear
  Vec3 before_ = Vec3::Zero();    // normal of the touch before in the tool frame; none yet: zero
  Vec3 touching_ = Vec3::Zero();  // of this one
  bool left_ = false;             // the artefact, and not clear of it yet
};

}  // namespace volcomp::sim
