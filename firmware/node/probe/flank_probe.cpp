#include "firmware/node/probe/flank_probe.hpp"

#include "comp/core/units.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint32_t kMost_nm = 20'000'000;  // largest radius of a ball

// Sub-indices of 2313h.
constexpr std::uint8_t kGear = 1;
constexpr std::uint8_t kSide = 2;
constexpr std::uint8_t kSlot = 3;
constexpr std::uint8_t kRadius = 6;
constexpr std::uint8_t kGate = 7;

// 2312h:03…08.
constexpr std::array<double FaceGear::*, 6> kFields{&FaceGear::module,   &FaceGear::pressure_angle,
                                                    &FaceGear::addendum, &FaceGear::shaper_addendum,
                                                    &FaceGear::r_in,     &FaceGear::r_out};

bool given(double value) { return !(value >= 0.0 && value <= 0.0); }

// 0, which no gear has, of anything else than a small whole number.
int teeth(double value) {
  if (!(value >= 0.0 && value <= 1000.0)) return 0;
  const auto whole = static_cast<int>(value);
  return given(value - whole) ? 0 : whole;
}

double mm(std::int32_t nm) { return nm / kNmPerMm; }

bool usable(std::uint32_t nm) { return nm > 0 && nm <= kMost_nm; }

}  // namespace

std::int32_t distance_nm(double distance_mm) {
  const double nm = distance_mm * kNmPerMm;
  if (!(nm > -2e9 && nm < 2e9)) return kNoDistance;
  return static_cast<std::int32_t>(nm < 0.0 ? nm - 0.5 : nm + 0.5);
}

void FlankProbe::reset() { announced_ = {}; }

// --- gear

Reason FlankProbe::derive_gear(const GearNumbers& numbers, FaceGear& gear,
                               const char*& field) const {
  const Preemptible preemptible(preemption_);
  gear.shaper_teeth = teeth(numbers[0]);
  gear.teeth = teeth(numbers[1]);
  const double* number = &numbers[2];
  for (double FaceGear::*const member : kFields) {
    if (given(*number)) gear.*member = *number;
    ++number;
  }
  gear.relief = {numbers[8], numbers[9], numbers[10]};
  const Status status = derive(gear);
  if (!status.ok()) field = status.where.field;
  return status.reason;
}

Reason FlankProbe::load_gear(std::uint32_t id) {
  FaceGear gear;
  if (id != 0) {
    const GearNumbers numbers = objects_.gear_number;
    const char* field = "";
    const Reason reason = derive_gear(numbers, gear, field);
    objects_.gear_reason = static_cast<std::uint8_t>(reason);
    for (char& letter : objects_.gear_field) {
      letter = *field;
      if (*field != '\0') ++field;
    }
    if (reason != Reason::ok) return reason;
  }
  gear_ = gear;
  announced_ = {};
  return Reason::ok;
}

// --- flank

std::uint8_t FlankProbe::find_bad(FaceFlank& flank) const {
  const FlankObjects& o = objects_.flank;
  if (o.gear == 0) return 0;
  if (o.gear != objects_.gear) return kGear;
  if (o.side != 1 && o.side != -1) return kSide;
  if (!choose_flank(gear_, o.side, o.slot, flank).ok()) return kSlot;
  if (!usable(o.radius_nm)) return kRadius;
  return usable(o.gate_nm) ? std::uint8_t{0} : kGate;
}

Reason FlankProbe::take() {
  FaceFlank flank;
  const std::uint8_t bad = find_bad(flank);
  const Reason reason = bad == kGear ? Reason::bad_gear : Reason::bad_point;
  objects_.flank_field = bad;
  objects_.flank_reason = bad == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(reason);
  if (bad != 0) return reason;
  flank_ = flank;
  announced_ = objects_.flank;
  return Reason::ok;
}

JudgedTouch FlankProbe::judge(const std::array<std::int32_t, 3>& centre_nm) const {
  const FaceProbing probing{mm(static_cast<std::int32_t>(announced_.radius_nm)),
                            mm(static_cast<std::int32_t>(announced_.gate_nm))};
  const Vec3 centre(mm(centre_nm[0]), mm(centre_nm[1]), mm(centre_nm[2]));
  return {announced_, judge_touch(gear_, flank_, probing, centre)};
}

}  // namespace volcomp::node
