#include "host_sim/sim/instruments/touch_probe.hpp"

#include <algorithm>
#include <utility>

namespace volcomp::sim {
namespace {

Stance between(const Stance& from, const Stance& to, double part) {
  Stance at;
  for (std::size_t a = 0; a < kMaxAxes; ++a) {
    at.position[a] = from.position[a] + part * (to.position[a] - from.position[a]);
    at.approach[a] = from.approach[a] + part * (to.approach[a] - from.approach[a]);
  }
  return at;
}

}  // namespace

TouchProbe::TouchProbe(const TrueMachine& machine, const Artefact& artefact, Settings settings)
    : machine_(machine), artefact_(artefact), settings_(std::move(settings)) {
  draw_scatter();
}

void TouchProbe::draw_scatter() {
  if (settings_.scatter_mm) scatter_ = settings_.scatter_mm(touch_);
}

Vec3 TouchProbe::ball_centre(const Stance& at) const {
  const Vec3 tool = machine_.chain.tool_point();
  return ideal_points(machine_.chain, at.position, tool).work +
         machine_.error(at.position, at.approach, tool).position_work;
}

double TouchProbe::margin_mm(const Stance& at) const {
  const Gap gap = artefact_.gap(ball_centre(at), settings_.radius_mm);
  if (!settings_.lobing_mm && !(settings_.hysteresis_mm > 0.0)) return gap.mm - scatter_;
  const Vec3 normal = in_tool(at, gap.normal);
  const double lobing = settings_.lobing_mm ? settings_.lobing_mm(normal) : 0.0;
  return gap.mm - scatter_ - lobing - 0.5 * settings_.hysteresis_mm * normal.dot(before_);
}

// What depends on the direction changes over degrees: the errors of the machine do not matter.
Vec3 TouchProbe::in_tool(const Stance& at, const Vec3& normal) const {
  const MachineChain& chain = machine_.chain;
  const Mat3 work = chain.ideal(chain.work(), at.position).R;
  const Mat3 tool = chain.ideal(chain.tool(), at.position).R;
  return tool.transpose() * (work * normal);
}

std::vector<ProbeEdge> TouchProbe::travel(const Stance& from, const Stance& to,
                                          std::int64_t period_ns) {
  if (!seen_) tripped_ = margin_mm(from) <= 0.0;
  seen_ = true;
  // Not before the ball is clear: more scatter at once would trip the probe again on its way back.
  constexpr double kClear_mm = 0.02;
  if (left_ && margin_mm(from) > kClear_mm) {
    draw_scatter();
    before_ = touching_;
    left_ = false;
  }
  const bool trips = margin_mm(to) <= 0.0;
  if (trips != tripped_) {
    const std::int64_t out_ns = crossing_ns(from, to, period_ns) + settings_.delay_ns;
    if (trips) {
      touched(out_ns);
      touching_ = in_tool(to, artefact_.gap(ball_centre(to), settings_.radius_mm).normal);
    } else {
      coming_.push_back({false, out_ns});
      ++touch_;
      left_ = true;
    }
    tripped_ = trips;
  }
  return due(period_ns);
}

void TouchProbe::touched(std::int64_t time_ns) {
  coming_.push_back({true, time_ns});
  std::int64_t last_ns = 0;
  for (const std::int64_t again_ns : settings_.bounces_ns) {
    coming_.push_back({false, time_ns + (last_ns + again_ns) / 2});
    coming_.push_back({true, time_ns + again_ns});
    last_ns = again_ns;
  }
}

// Bisection: the margin has different signs at the ends.
std::int64_t TouchProbe::crossing_ns(const Stance& from, const Stance& to,
                                     std::int64_t period_ns) const {
  const bool tripped_before = margin_mm(from) <= 0.0;
  std::int64_t before = 0;
  std::int64_t after = period_ns;
  while (after - before > 1) {
    const std::int64_t middle = before + (after - before) / 2;
    const double part = static_cast<double>(middle) / static_cast<double>(period_ns);
    const bool tripped = margin_mm(between(from, to, part)) <= 0.0;
    (tripped == tripped_before ? before : after) = middle;
  }
  return after;
}

// Those of this period; the others are counted from the begin of the next.
std::vector<ProbeEdge> TouchProbe::due(std::int64_t period_ns) {
  const auto later = std::stable_partition(
      coming_.begin(), coming_.end(),
      [period_ns](const ProbeEdge& edge) { return edge.time_ns < period_ns; });
  std::vector<ProbeEdge> now(coming_.begin(), later);
  coming_.erase(coming_.begin(), later);
  for (ProbeEdge& edge : coming_)
    edge.time_ns -= period_ns;
  return now;
}

}  // namespace volcomp::sim
