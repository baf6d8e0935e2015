#pragma once
// One instant of a helical stroke: integers in, synchronisation error and X error out
// (docs/papers/internal-helical.md, "What we do").

#include <cstdint>

#include "comp/core/units.hpp"
#include "comp/tables/direction.hpp"

namespace volcomp {

// One axis. Linear: nm; rotary: 2^-40 turn, counted through.
struct TrackedAxis {
  std::int64_t command = 0;  // the controller's own at this instant, without any offset of ours
  std::int64_t actual = 0;   // of the encoder
  std::int32_t age_ns = 0;   // this instant minus the one at which `actual` was taken
  bool valid = false;        // false: frame lost, encoder fault, not a number
};

struct HelixFrame {
  TrackedAxis x;
  TrackedAxis z;
  TrackedAxis c;
  std::uint16_t sequence = 0;  // counts ticks; a gap means that a frame was lost
  std::uint16_t slot = 0;      // of the gear, 0…teeth − 1
  Direction stroke = Direction::unknown;
  bool in_face = false;  // the wheel is within the face width
};

// What became of a frame.
enum class FrameUse : std::uint8_t {
  used,
  starting,     // the first after a gap: nothing to interpolate from yet
  gap,          // the sequence counter jumped
  invalid,      // an axis has no position
  skewed,       // the positions of Z and C, or of X, lie too far apart in time
  implausible,  // actual and command differ by more than kMostTrackingError
};
inline constexpr int kFrameUses = 6;

// 1 mm, or 5.6 mrad in 2^-40 turn: beyond it an axis does not follow its command.
inline constexpr std::int64_t kMostLinearError = 1'000'000;
inline constexpr std::int64_t kMostRotaryError = 980'000'000;

// What the axes do to the flank.
struct HelixSignals {
  float e_x_nm = 0.0F;
  float e_z_nm = 0.0F;
  float e_c_rad = 0.0F;
  float e_s_rad = 0.0F;   // e_C + e_Z / p
  float sync_um = 0.0F;   // S1 = r_b cos β_b e_s: opposite on the two flanks
  float lag_c_um = 0.0F;  // the same of e_C alone: what it would be if Z did not lag as well
  float x_um = 0.0F;      // S2: equal on both flanks
};

// Constants of gear and wheel, from commissioning.
struct HelixGains {
  float turn_per_nm = 0.0F;       // 1/p, rad per nm, signed
  float flank_um_per_rad = 0.0F;  // 1000 r_b cos β_b
  float flank_per_x = 0.0F;       // dn per X error, both mm, magnitude: 0.325 for the paper's gear
};

// Turns frames into signals. Subtracts before it converts; no library calls, the same bits on every
// target. Interrupt-safe.
class HelixTracker {
 public:
  HelixTracker() = default;
  // `tick_ns`: between two frames; `most_skew_ns`: between the positions of two axes.
  HelixTracker(const HelixGains& gains, std::int32_t tick_ns, std::int32_t most_skew_ns)
      : gains_(gains), tick_ns_(tick_ns), most_skew_ns_(most_skew_ns) {}

  FrameUse take(const HelixFrame& frame, HelixSignals& signals) {
    const auto steps = static_cast<std::uint16_t>(frame.sequence - last_.sequence);
    missed_ = started_ && steps > 1 ? static_cast<std::uint16_t>(steps - 1U) : std::uint16_t{0};
    const FrameUse use = judge(frame, steps == 1);
    if (use == FrameUse::used) evaluate(frame, signals);
    known_ = frame.x.valid && frame.z.valid && frame.c.valid;
    last_ = frame;
    started_ = true;
    return use;
  }

  // Frames that were lost before the last one.
  [[nodiscard]] std::uint16_t missed() const { return missed_; }

 private:
  [[nodiscard]] FrameUse judge(const HelixFrame& frame, bool follows) const {
    if (!frame.x.valid || !frame.z.valid || !frame.c.valid) return FrameUse::invalid;
    if (started_ && !follows) return FrameUse::gap;
    if (!started_ || !known_) return FrameUse::starting;
    if (apart(frame.z, frame.c) || apart(frame.x, frame.c)) return FrameUse::skewed;
    if (far(frame.x, kMostLinearError) || far(frame.z, kMostLinearError) ||
        far(frame.c, kMostRotaryError))
      return FrameUse::implausible;
    return FrameUse::used;
  }

  [[nodiscard]] bool apart(const TrackedAxis& a, const TrackedAxis& b) const {
    const std::int64_t between = std::int64_t{a.age_ns} - b.age_ns;
    return between > most_skew_ns_ || between < -most_skew_ns_;
  }

  // Positions may stand anywhere: the difference wraps instead of overflowing.
  static std::int64_t difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
  }
  static bool far(const TrackedAxis& axis, std::int64_t most) {
    const std::int64_t e = difference(axis.actual, axis.command);
    return e > most || e < -most;
  }

  // actual − command, the actual position carried on to this instant by the last two samples.
  [[nodiscard]] float error(const TrackedAxis& now, const TrackedAxis& before) const {
    const std::int64_t e = difference(now.actual, now.command);
    const std::int64_t moved = difference(now.actual, before.actual);
    const std::int32_t between = tick_ns_ + before.age_ns - now.age_ns;
    const float lead =
        between > 0 ? static_cast<float>(now.age_ns) / static_cast<float>(between) : 0.0F;
    return static_cast<float>(e) + static_cast<float>(moved) * lead;
  }

  void evaluate(const HelixFrame& frame, HelixSignals& s) const {
    constexpr auto kRadPerUnit = static_cast<float>(1.0 / kUnitsPerRad);
    s.e_x_nm = error(frame.x, last_.x);
    s.e_z_nm = error(frame.z, last_.z);
    s.e_c_rad = error(frame.c, last_.c) * kRadPerUnit;
    s.e_s_rad = s.e_c_rad + s.e_z_nm * gains_.turn_per_nm;
    s.sync_um = s.e_s_rad * gains_.flank_um_per_rad;
    s.lag_c_um = s.e_c_rad * gains_.flank_um_per_rad;
    s.x_um = s.e_x_nm * (gains_.flank_per_x * 1e-3F);
  }

  HelixGains gains_{};
  std::int32_t tick_ns_ = 1'000'000;
  std::int32_t most_skew_ns_ = 0;
  HelixFrame last_{};
  std::uint16_t missed_ = 0;
  bool started_ = false;
  bool known_ = false;  // the last frame had all positions
};

}  // namespace volcomp
