#include "host_sim/experiments/internal_helical/grinding.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/experiments/internal_helical/grinding_job.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

constexpr int kDwell_ticks = 200;  // longer than every lag

// Strokes around the contact that can cut a crest: ±3 mm stand 30 µm off.
constexpr double kWindow_mm = 3.0;
constexpr std::size_t kCentre = 120;
constexpr double kSpacing_mm = kWindow_mm / kCentre;

// Looks a pass up by the position of the wheel: the helix of an ideal motion maps onto itself, so a
// lag common to Z and C changes only the time.
class ByPosition {
 public:
  explicit ByPosition(const StrokeTrace& pass) : pass_(pass) {}

  [[nodiscard]] LagErrors at(double z) const {
    const auto before = [this](const LagErrors& e, double place) {
      return pass_.direction == Direction::forward ? e.z < place : e.z > place;
    };
    const auto next = std::lower_bound(pass_.at.begin() + 1, pass_.at.end() - 1, z, before);
    const LagErrors& a = *(next - 1);
    const LagErrors& b = *next;
    const double part = (z - a.z) / (b.z - a.z);
    const auto between = [part](double u, double v) { return u + part * (v - u); };
    return {z, between(a.e_x, b.e_x), between(a.e_z, b.e_z), between(a.e_c, b.e_c)};
  }

 private:
  const StrokeTrace& pass_;
};

}  // namespace

double slot_place(const InternalGear& gear, std::uint16_t slot) {
  return -2.0 * kPi * slot / gear.teeth;
}

GrindingProcess::GrindingProcess(const host::GrindingFile& job, const GrindingTruth& truth,
                                 std::uint64_t seed)
    : teeth_(job.gear.teeth),
      plan_(job, form_wheel(job).centre_distance),
      plant_(job.gear, truth, plan_.standing(), seed) {}

void GrindingProcess::rest(const Sync& sync) const {
  for (int tick = 0; tick < kDwell_ticks; ++tick)
    sync(plan_.standing());
}

std::vector<StrokeTrace> GrindingProcess::round(const Sync& sync) {
  rest(sync);
  std::vector<StrokeTrace> traces;
  traces.reserve(static_cast<std::size_t>(teeth_));
  for (int k = 0; k < teeth_; ++k)
    traces.push_back(pass(sync));
  return traces;
}

StrokeTrace GrindingProcess::pass(const Sync& sync) {
  plan_.begin_pass();
  StrokeTrace trace;
  trace.slot = plan_.index(0).slot;
  trace.direction = plan_.index(0).stroke;
  plant_.begin_pass(trace.slot);
  for (int tick = 0; tick < plan_.index_ticks(); ++tick)
    sync(plan_.index(tick));
  trace.at.reserve(static_cast<std::size_t>(plan_.stroke_ticks()));
  for (int tick = 0; tick < plan_.stroke_ticks(); ++tick) {
    const StrokeStep step = plan_.stroke(tick);
    trace.at.push_back(plant_.errors(step));
    sync(step);
  }
  plan_.end_pass();
  return trace;
}

MachineChain helical_chain() {
  MachineChain chain;
  host::require(MachineChain::build(internal_grinder(GrinderY::none), chain), "grinder");
  return chain;
}

FlankGrinding::FlankGrinding(const host::GrindingFile& job, const GrindingTruth& truth)
    : job_(job), truth_(truth) {
  const InternalGear& gear = job.gear;
  const double tip = volcomp::roll_length(gear, gear.r_tip);
  const double form = volcomp::roll_length(gear, gear.r + gear.module);
  for (std::size_t i = 0; i < kProfilePoints; ++i)
    roll_[i] = tip + (form - tip) * static_cast<double>(i) / (kProfilePoints - 1);
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
    pitch_[side] = place_at(side, volcomp::roll_length(gear, gear.r));
    for (std::size_t i = 0; i < kProfilePoints; ++i)
      profile_[side][i] = place_at(side, roll_[i]);
  }
}

FlankGrinding::Place FlankGrinding::place_at(std::size_t side, double roll_length) const {
  const WheelSetup setup = form_wheel(job_);
  const double radius = std::hypot(job_.gear.r_b, roll_length);
  const FlankPlace at{kHelicalSides[side], radius, 0.0};
  Place place;
  ContactInstant instant;
  host::require(contact_instant(job_.gear, setup, at, instant), "contact");
  place.stroke = instant.stroke;
  host::require(flank_sensitivity(helical_chain(), job_.gear, setup, at, place.rows), "contact");
  host::require(contact_curvature(job_.gear, setup, at.side, radius, place.kappa), "contact");
  // Read in the transverse plane, less material towards the tip on both flanks.
  const double part = (roll_length - roll_.front()) / (roll_.back() - roll_.front()) - 0.5;
  place.wheel_form = truth_.wheel_form_mm * std::cos(job_.gear.beta_b) * part;
  return place;
}

double FlankGrinding::flank_per_x() const { return std::abs(pitch_[0].rows[kGrinderX](0)); }

// The slot stands where slot 0 stands, the gear turned back: so is its run-out.
double FlankGrinding::first_order(const Place& place, const LagErrors& errors,
                                  std::uint16_t slot) const {
  const double angle = -slot_place(job_.gear, slot);
  const double turned = errors.z * job_.gear.turn_per_mm + angle;
  const double runout = truth_.runout_phase - angle;
  const SensitivityRow& c = place.rows[kGrinderC];
  return place.wheel_form + place.rows[kGrinderX](0) * errors.e_x +
         place.rows[kGrinderZ](2) * errors.e_z +
         c(5) * (errors.e_c + truth_.invisible_rad * std::cos(turned)) +
         truth_.runout_mm * (c(0) * std::cos(runout) + c(1) * std::sin(runout));
}

double FlankGrinding::ground(const Place& place, const StrokeTrace& pass) const {
  std::array<double, 2 * kCentre + 1> dn{};
  const ByPosition wheel(pass);
  for (std::size_t k = 0; k < dn.size(); ++k) {
    const double away = (static_cast<double>(k) - static_cast<double>(kCentre)) * kSpacing_mm;
    dn[k] = first_order(place, wheel.at(place.stroke + away), pass.slot);
  }
  constexpr double kAnyCut = 1e-6;
  return lower_envelope(place.kappa, {dn.data(), dn.size()}, kSpacing_mm, kCentre, kAnyCut).dn;
}

double FlankGrinding::pitch_point(const StrokeTrace& pass, std::size_t side) const {
  return ground(pitch_.at(side), pass);
}

double FlankGrinding::profile_point(const StrokeTrace& pass, std::size_t side,
                                    std::size_t point) const {
  return ground(profile_.at(side).at(point), pass);
}

}  // namespace volcomp::internal_helical
