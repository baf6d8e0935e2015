#include "host_sim/scenarios/internal_helical/process.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::sim {
namespace {

constexpr double kTravel_mm = kFaceWidth_mm + 2.0 * kOverrun_mm;
constexpr double kRampTime_s = kStrokeFeed_mm_per_s / kStrokeAcceleration_mm_per_s2;
constexpr double kStrokeTime_s = kTravel_mm / kStrokeFeed_mm_per_s + kRampTime_s;

// Way from rest to rest after a time: constant acceleration, feed, deceleration.
double way_after(double t) {
  const double rest = kStrokeTime_s - t;
  if (rest <= 0.0) return kTravel_mm;
  const auto ramp = [](double s) { return 0.5 * kStrokeAcceleration_mm_per_s2 * s * s; };
  if (t < kRampTime_s) return ramp(t);
  if (rest < kRampTime_s) return kTravel_mm - ramp(rest);
  return kStrokeFeed_mm_per_s * (t - 0.5 * kRampTime_s);
}

std::int64_t encoder(double value, double resolution, double units) {
  return to_units(std::round(value / resolution) * resolution, units);
}

}  // namespace

HelixFrame helix_frame(const ProcessState& state) {
  HelixFrame frame;
  frame.x = state.x;
  frame.z = state.z;
  frame.c = state.c;
  frame.sequence = state.sequence;
  frame.slot = state.slot;
  frame.stroke = state.stroke;
  frame.in_face = state.in_face;
  return frame;
}

StrokeState stroke_state(const ProcessState& state) {
  StrokeState s;
  s.z_command = state.z.command;
  s.feed_nm_per_s = state.feed_nm_per_s;
  s.slot = state.slot;
  s.stroke = state.stroke;
  s.in_face = state.in_face;
  s.stroke_end = state.stroke_end;
  s.fresh = state.z.valid && state.c.valid;
  s.homed = true;
  return s;
}

double slot_place(const InternalGear& gear, std::uint16_t slot) {
  return -2.0 * kPi * slot / gear.teeth;
}

GrindingProcess::GrindingProcess(const InternalGear& gear, const GrindingTruth& truth,
                                 std::uint64_t seed)
    : gear_(gear), truth_(truth), random_(seed), z_(-0.5 * kTravel_mm) {
  for (int k = 0; k < gear.teeth; ++k)
    slot_error_.push_back(random_.normal(truth.slot_rms_rad));
  c_ = -z_ * gear.turn_per_mm;
}

std::vector<StrokeTrace> GrindingProcess::round(const StrokeCompensation& compensation) {
  std::vector<StrokeTrace> traces(static_cast<std::size_t>(gear_.teeth));
  for (std::size_t k = 0; k < traces.size(); ++k) {
    traces[k].slot = static_cast<std::uint16_t>(k);
    traces[k].direction = next_;
    grind_slot(traces[k], compensation);
    next_ = next_ == Direction::forward ? Direction::backward : Direction::forward;
  }
  return traces;
}

// Between the slots C indexes at rest, which takes as long as it takes: only its error is left.
void GrindingProcess::grind_slot(StrokeTrace& trace, const StrokeCompensation& compensation) {
  constexpr auto kTicks = static_cast<int>(kStrokeTime_s / kStrokeTick_s) + 2;
  const double sign = trace.direction == Direction::forward ? 1.0 : -1.0;
  const double begin = -0.5 * sign * kTravel_mm;
  pass_error_ = random_.normal(truth_.pass_rms_rad);
  x_error_ = random_.normal(truth_.hunting_rms_mm);
  trace.at.reserve(kTicks);
  for (int tick = 0; tick < kTicks; ++tick) {
    const double z = begin + sign * way_after(tick * kStrokeTick_s);
    const double c = -z * gear_.turn_per_mm;
    LagErrors errors;
    errors.z = z_ + truth_.ripple_mm * std::sin(2.0 * kPi * z_ / truth_.ripple_wavelength_mm);
    errors.e_x = x_error_;
    errors.e_z = errors.z - z;
    errors.e_c = c_ - c + indexing_error(trace, z);
    trace.at.push_back(errors);
    ProcessState state = observe(trace, z, errors);
    state.stroke_end = tick == 0;
    const double offset = compensation(state) * (256.0 / kUnitsPerRad);
    // Euler steps: at constant feed the lag is v / K_v exactly.
    z_ += truth_.gain_z * kStrokeTick_s * (z - z_);
    c_ += truth_.gain_c * kStrokeTick_s * (c + offset - c_);
  }
}

double GrindingProcess::indexing_error(const StrokeTrace& trace, double z) const {
  const double turned = z * gear_.turn_per_mm - slot_place(gear_, trace.slot);
  return truth_.visible_rad * std::cos(turned - truth_.visible_phase) + slot_error_[trace.slot] +
         pass_error_;
}

ProcessState GrindingProcess::observe(const StrokeTrace& trace, double z, const LagErrors& errors) {
  const double c = slot_place(gear_, trace.slot) - z * gear_.turn_per_mm;
  ProcessState s;
  s.x = {0, encoder(errors.e_x, truth_.resolution_z_mm, kNmPerMm), 0, true};
  s.z = {to_nm(z), encoder(errors.z, truth_.resolution_z_mm, kNmPerMm), 0, true};
  s.c = {to_units(c, kUnitsPerRad), encoder(c + errors.e_c, truth_.resolution_c_rad, kUnitsPerRad),
         0, true};
  s.a = {to_units(gear_.helix_angle, kUnitsPerRad), to_units(gear_.helix_angle, kUnitsPerRad), 0,
         true};
  s.sequence = ++sequence_;
  s.slot = trace.slot;
  s.stroke = trace.direction;
  s.in_face = std::abs(z) <= 0.5 * kFaceWidth_mm;
  s.feed_nm_per_s = static_cast<std::int32_t>(to_nm(kStrokeFeed_mm_per_s));
  return s;
}

}  // namespace volcomp::sim
