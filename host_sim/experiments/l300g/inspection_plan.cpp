#include "host_sim/experiments/l300g/inspection_plan.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_inspection.hpp"

namespace volcomp::l300g {
namespace {

// Besides the range of 1995, in hundredths of it: before it, as errors of the machine shift the
// foot of a normal; behind it as far as the edition of 2013 goes.
constexpr int kBefore = 3;
constexpr int kBeyond = 4;
constexpr double kPast_mm = 0.2;       // how far a touch may be late
constexpr double kClearance_mm = 3.0;  // between the gear and the ball beside it

std::vector<double> places(const EvaluationRange& range, std::size_t points) {
  const int steps = static_cast<int>(points) - 1;
  const auto beside = [steps](int hundredths) { return (hundredths * steps + 99) / 100; };
  std::vector<double> at;
  for (int i = -beside(kBefore); i <= steps + beside(kBeyond); ++i)
    at.push_back(range.low + i * (range.high - range.low) / steps);
  return at;
}

}  // namespace

double pitch_roll(const InvoluteGear& gear) { return gear.r * std::sin(gear.pressure_angle); }

std::vector<int> traced_teeth(const InvoluteGear& gear, const TracePlan& plan) {
  std::vector<int> teeth;
  for (std::size_t k = 0; k < plan.teeth; ++k)
    teeth.push_back(static_cast<int>(k * static_cast<std::size_t>(gear.teeth) / plan.teeth));
  return teeth;
}

std::vector<FlankTouch> profile_touches(const InvoluteGear& gear, const Flank& flank,
                                        std::size_t points) {
  std::vector<FlankTouch> touches;
  for (const double s : places(host::profile_range(gear, 0.92), points))
    touches.push_back({flank, s, 0.0});
  return touches;
}

// A lead ends with the gear.
std::vector<FlankTouch> lead_touches(const InvoluteGear& gear, const Flank& flank,
                                     std::size_t points) {
  std::vector<FlankTouch> touches;
  for (const double x : places(host::lead_range(gear), points)) {
    if (x >= 0.0 && x <= gear.width) touches.push_back({flank, pitch_roll(gear), x});
  }
  return touches;
}

std::vector<FlankTouch> pitch_touches(const InvoluteGear& gear, FlankSide side) {
  std::vector<FlankTouch> touches;
  touches.reserve(static_cast<std::size_t>(gear.teeth));
  for (int tooth = 0; tooth < gear.teeth; ++tooth)
    touches.push_back({{side, tooth}, pitch_roll(gear), 0.5 * gear.width});
  return touches;
}

void require_ball_fits(const InvoluteGear& gear, double ball_radius, const std::string& name) {
  constexpr double kClear_mm = 0.5;
  const FlankTouch deepest = profile_touches(gear, {FlankSide::left, 0}).front();
  const Transverse centre = ball_centre_at(gear, deepest.flank, deepest.roll_length, ball_radius);
  FlankDistance other;
  const bool beyond = distance_from_flank(gear, {FlankSide::right, 1}, centre, 0.0, other).ok();
  if (!beyond || other.distance < ball_radius + kClear_mm)
    throw host::UserError(fmt::format(
        "{}: a ball of radius {:.4f} mm does not fit between the teeth", name, ball_radius));
}

double InspectionSetup::beside() const {
  return geometry.datum.y + 0.5 * gear.tip_diameter + ball_radius + kClearance_mm;
}

FlankMove flank_move(const InspectionSetup& setup, const FlankTouch& touch, double stand_off) {
  const SwingArm& arm = setup.geometry.arm;
  FlankMove move;
  host::require(touch_pose(arm, setup.geometry.datum, setup.gear, setup.style, touch,
                           setup.ball_radius, move.contact),
                "touch");
  move.lift_mm = arm_lift(arm, move.contact[2]);
  const double outwards = touch.flank.side == FlankSide::left ? 1.0 : -1.0;
  move.from = move.beyond = move.contact;
  move.from[2] += outwards * stand_off / move.lift_mm;
  move.beyond[2] -= outwards * kPast_mm / move.lift_mm;
  const FlankPoint flank = flank_at(setup.gear, touch.flank, touch.roll_length, touch.x);
  move.normal = Vec3(0.0, flank.normal.y, flank.normal.z);
  return move;
}

}  // namespace volcomp::l300g
