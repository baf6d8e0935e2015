#pragma once
// Touches of a flank of a face gear: holds the gear and the flank announced before the touch, and
// judges the touch by the kernel (comp/probe/face_touch.hpp).

#include "comp/probe/face_touch.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/probe/probe_objects.hpp"

namespace volcomp::node {

// A judged touch, with the flank it was announced for.
struct JudgedTouch {
  FlankObjects flank;
  FaceTouch touch;
};

// λ in nm, rounded half away from zero; kNoDistance of NaN and beyond 2 m.
[[nodiscard]] std::int32_t distance_nm(double distance_mm);

class FlankProbe {
 public:
  FlankProbe(ProbeObjects& objects, Preemption* preemption)
      : objects_(objects), preemption_(preemption) {}

  void reset();

  // The gear of 2312h is number `id` from now on; 0: there is none. No flank is announced then.
  // Refuses bad_gear, with the field in 2311h; the gear in force stays. The tick may come
  // meanwhile.
  [[nodiscard]] Reason load_gear(std::uint32_t id);

  // Announces the flank of 2313h for the next touches, none with gear 0 there. Refuses with
  // 2310h:05 and :06, what was announced stays: bad_gear (not the one that is loaded), bad_point
  // (side, slot, radius or gate).
  [[nodiscard]] Reason take();

  [[nodiscard]] bool announced() const { return announced_.gear != 0; }

  // Judges a touch on the announced flank. `centre_nm`: of the ball, in the workpiece frame, which
  // is that of the gear, saturated. Equals judge_touch() of these numbers in mm bit for bit.
  [[nodiscard]] JudgedTouch judge(const std::array<std::int32_t, 3>& centre_nm) const;

 private:
  // Sub-index of what is bad in 2313h, 0: nothing.
  [[nodiscard]] std::uint8_t find_bad(FaceFlank& flank) const;
  [[nodiscard]] Reason derive_gear(const GearNumbers& numbers, FaceGear& gear,
                                   const char*& field) const;

  ProbeObjects& objects_;
  Preemption* preemption_;
  FaceGear gear_{};
  FaceFlank flank_{};
  FlankObjects announced_{};
};

}  // namespace volcomp::node
