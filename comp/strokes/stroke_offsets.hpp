#pragma once
// The offset of C while a helical slot is ground: T1(z, direction) + T2(slot), through the limiter
// of offsets (docs/papers/internal-helical.md, "What we do").
//
// Tables are staged in the background and taken over at the end of a stroke, outside the face: a
// change in the middle of a slot would be a step on the flank.

#include <array>
#include <cmath>

#include "comp/core/atomic_word.hpp"
#include "comp/core/span.hpp"
#include "comp/core/units.hpp"
#include "comp/tables/direction.hpp"
#include "comp/tick/limiter.hpp"
#include "comp/tick/offset_limiter.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp {

// In the place of kAccelerationLimited: an offset that its acceleration holds back shows
// kRateLimited.
inline constexpr std::uint16_t kOtherFeed = 1U << 14U;  // the tables are for another feed rate

// What the background fills in, in rad.
struct StrokeTableSource {
  Span<const double> forward;      // T1 on the way up, `backward` of the same length
  Span<const double> backward;     // and down
  Span<const double> slot;         // T2; may be empty
  std::int64_t z0_nm = 0;          // first node
  std::uint32_t pitch_nm = 0;      // > 0
  std::int32_t feed_nm_per_s = 0;  // at which they were learned, > 0
};

struct StrokeOffsetSettings {
  std::int32_t rate = 1'000;       // largest change per tick, 2^-32 turn, ≥ 1
  std::uint32_t stale_ticks = 20;  // without a fresh frame for more: the offset goes to 0
  std::int32_t acceleration = 0;   // largest change of the change per tick; 0 or ≥ 2·rate: none
};

struct StrokeState {
  std::int64_t z_command = 0;      // original, nm
  std::int32_t feed_nm_per_s = 0;  // programmed, magnitude
  std::uint16_t slot = 0;
  Direction stroke = Direction::unknown;
  bool in_face = false;
  bool stroke_end = false;  // the wheel turns round
  bool fresh = false;       // false: the frame is missing; the rest is ignored
  bool homed = false;       // Z and C are referenced
};

template <std::size_t Nodes, std::size_t Slots>
class StrokeOffsets {
 public:
  // --- background

  // Forgets all tables. Refused: bad_setting (field). Only while no tick can come.
  Status configure(const StrokeOffsetSettings& settings) {
    Where where;
    const OffsetLimits limits{kMostRounded, settings.rate, settings.rate, settings.acceleration};
    where.field = refused_field(limits);
    if (settings.rate < 1 || settings.rate > kMostRounded) where.field = "rate";
    if (settings.stale_ticks < 1) where.field = "stale_ticks";
    if (where.field != nullptr) return refuse(Reason::bad_setting, where);
    settings_ = settings;
    output_.change(OffsetBounds(limits));
    staged_ = active_ = false;
    request_.store(Request::none, std::memory_order_relaxed);
    restart();
    return {};
  }

  // The offset starts at 0 again; tables stay what they are. Only while no tick can come.
  void restart() {
    output_.start(0);
    status_ = 0;
    stale_for_ = 0;
  }

  // Into the spare buffer. Refused, and the active tables go on: hand_over_pending, too_few_knots,
  // too_many_knots, length_mismatch, pitch_not_positive, travel_too_long, bad_setting ("feed"),
  // not_finite and bound_exceeded (beyond ±6.1 mrad) with index.
  Status stage(const StrokeTableSource& source) {
    if (pending()) return refuse(Reason::hand_over_pending);
    staged_ = false;
    if (const Status s = check(source); !s.ok()) return s;
    Tables& spare = buffer_[spare_];
    spare.z0_nm = source.z0_nm;
    spare.pitch_nm = source.pitch_nm;
    spare.per_pitch = 1.0F / static_cast<float>(source.pitch_nm);
    spare.nodes = static_cast<std::uint32_t>(source.forward.size());
    spare.slots = static_cast<std::uint32_t>(source.slot.size());
    spare.feed_nm_per_s = source.feed_nm_per_s;
    for (std::size_t j = 0; j < source.forward.size(); ++j) {
      spare.stroke[0][j] = in_units(source.forward[j]);
      spare.stroke[1][j] = in_units(source.backward[j]);
    }
    for (std::size_t k = 0; k < source.slot.size(); ++k)
      spare.slot[k] = in_units(source.slot[k]);
    staged_ = true;
    return {};
  }

  // From the end of the next stroke on. Refused: not_staged.
  Status activate() {
    if (!staged_) return refuse(Reason::not_staged);
    staged_ = false;
    request_.store(Request::activate, std::memory_order_release);
    return {};
  }

  // The offset goes to 0 at its rate, at once.
  void deactivate() { request_.store(Request::deactivate, std::memory_order_release); }

  [[nodiscard]] bool pending() const {
    return request_.load(std::memory_order_acquire) != Request::none;
  }
  // Tables are in force. Background or interrupt.
  [[nodiscard]] bool active() const { return active_; }
  // Why there is no correction although tables are active: feed_mismatch (value = mm/s of the
  // tables), ok otherwise.
  [[nodiscard]] Status feed_status() const {
    if ((status_ & kOtherFeed) == 0 || !active_) return {};
    Where where;
    where.has_value = true;
    where.value = static_cast<double>(buffer_[1U - spare_].feed_nm_per_s) / kNmPerMm;
    return refuse(Reason::feed_mismatch, where);
  }
  // Sticky, saturating.
  [[nodiscard]] std::uint32_t out_of_table() const { return out_of_table_; }
  [[nodiscard]] std::uint32_t stale() const { return stale_count_; }

  // --- interrupt

  // What to add to the command of C, 2^-32 turn.
  std::int32_t tick(const StrokeState& state) {
    take_request(state);
    status_ = 0;
    const bool holds = !state.fresh && stale_again() <= settings_.stale_ticks;
    const std::uint32_t limited = holds ? output_.hold() : output_.follow(wanted(state));
    if (limited != 0) flag(kRateLimited);
    if (status_ == 0) status_ = kValid;
    return output_.offset();
  }

  // Status of the last tick: bits of StatusBit and kOtherFeed.
  [[nodiscard]] std::uint16_t status() const { return status_; }

 private:
  enum class Request : std::uint32_t { none, activate, deactivate };

  struct Tables {
    std::array<std::array<float, Nodes>, 2> stroke{};  // 2^-32 turn
    std::array<float, Slots> slot{};
    std::int64_t z0_nm = 0;
    std::uint32_t pitch_nm = 1;
    float per_pitch = 1.0F;
    std::uint32_t nodes = 0;
    std::uint32_t slots = 0;
    std::int32_t feed_nm_per_s = 0;
  };

  static constexpr double kUnitsPerRadian = kUnitsPerRad / 256.0;

  static float in_units(double rad) { return static_cast<float>(rad * kUnitsPerRadian); }

  static Status check(const StrokeTableSource& source) {
    Where where;
    where.count = static_cast<int>(source.forward.size());
    if (source.forward.size() < 2) return refuse(Reason::too_few_knots, where);
    if (source.forward.size() > Nodes) return refuse(Reason::too_many_knots, where);
    if (source.forward.size() != source.backward.size()) return refuse(Reason::length_mismatch);
    where.count = static_cast<int>(source.slot.size());
    where.field = "slot";
    if (source.slot.size() > Slots) return refuse(Reason::too_many_knots, where);
    if (source.pitch_nm == 0) return refuse(Reason::pitch_not_positive);
    if (std::uint64_t{source.pitch_nm} * source.forward.size() > UINT32_MAX)
      return refuse(Reason::travel_too_long);
    where = {};
    where.field = "feed";
    if (source.feed_nm_per_s <= 0) return refuse(Reason::bad_setting, where);
    if (const Status s = check_values("forward", source.forward); !s.ok()) return s;
    if (const Status s = check_values("backward", source.backward); !s.ok()) return s;
    return check_values("slot", source.slot);
  }

  static Status check_values(const char* field, Span<const double> values) {
    Where where;
    where.field = field;
    for (std::size_t k = 0; k < values.size(); ++k) {
      where.index = static_cast<int>(k);
      if (!std::isfinite(values[k])) return refuse(Reason::not_finite, where);
      // Half of what the rounding represents, so that T1 + T2 stays within it.
      if (std::abs(values[k]) * kUnitsPerRadian > 0.5 * kMostRounded)
        return refuse(Reason::bound_exceeded, where);
    }
    return {};
  }

  void take_request(const StrokeState& state) {
    Request request = request_.load(std::memory_order_acquire);
    if (request == Request::none) return;
    if (request == Request::deactivate) {
      active_ = false;
    } else {
      if (!state.fresh || !state.stroke_end || state.in_face) return;
      spare_ = 1U - spare_;
      active_ = true;
    }
    // One that has come meanwhile, on another core, waits for the next tick.
    request_.compare_exchange_strong(request, Request::none, std::memory_order_acq_rel);
  }

  void flag(std::uint16_t bit) { status_ = static_cast<std::uint16_t>(status_ | bit); }
  static void count(std::uint32_t& counter) {
    if (counter < UINT32_MAX) ++counter;
  }

  // One more tick without a fresh frame; how many they are.
  std::uint32_t stale_again() {
    count(stale_count_);
    count(stale_for_);
    flag(kStale);
    return stale_for_;
  }

  // Before the limiter. Not fresh: for too long.
  std::int32_t wanted(const StrokeState& state) {
    if (!state.fresh) {
      flag(kDropped);
      return 0;
    }
    stale_for_ = 0;
    if (!active_) flag(kNoTables);
    if (!state.homed) flag(kNotHomed);
    if (active_ && other_feed(state.feed_nm_per_s)) flag(kOtherFeed);
    if (status_ != 0) return 0;
    const float sum = offset(state);
    const Magnitude most(kMaxRounded);
    if (!exceeds(sum, most)) return round_half_even(sum);
    flag(kClamped);
    return Magnitude::finite(sum) ? round_half_even(most.signed_like(sum)) : 0;
  }

  // More than 2 % off.
  [[nodiscard]] bool other_feed(std::int32_t feed) const {
    const std::int64_t learned = buffer_[1U - spare_].feed_nm_per_s;
    const std::int64_t off = 50 * (feed - learned);
    return off > learned || off < -learned;
  }

  float offset(const StrokeState& state) {
    const Tables& t = buffer_[1U - spare_];
    const std::uint32_t last = t.pitch_nm * (t.nodes - 1U);
    auto distance = static_cast<std::int64_t>(static_cast<std::uint64_t>(state.z_command) -
                                              static_cast<std::uint64_t>(t.z0_nm));
    if (distance < 0 || distance > last || (state.slot >= t.slots && t.slots != 0)) {
      flag(kOutOfRange);
      count(out_of_table_);
      distance = distance < 0 ? 0 : distance > last ? last : distance;
    }
    const auto along = static_cast<std::uint32_t>(distance);
    std::uint32_t j = along / t.pitch_nm;
    if (j > t.nodes - 2U) j = t.nodes - 2U;
    const float part = static_cast<float>(along - j * t.pitch_nm) * t.per_pitch;
    const float slot = state.slot < t.slots ? t.slot[state.slot] : 0.0F;
    if (state.stroke != Direction::unknown)
      return between(t.stroke[static_cast<std::size_t>(state.stroke)], j, part) + slot;
    flag(kDirectionUnknown);
    return 0.5F * (between(t.stroke[0], j, part) + between(t.stroke[1], j, part)) + slot;
  }

  static float between(const std::array<float, Nodes>& values, std::uint32_t j, float part) {
    return values[j] + part * (values[j + 1U] - values[j]);
  }

  StrokeOffsetSettings settings_{};
  std::array<Tables, 2> buffer_{};
  std::uint32_t spare_ = 0;  // written by the tick, read by the background while nothing is pending
  bool staged_ = false;
  bool active_ = false;
  OffsetLimiter<true> output_{};
  std::uint16_t status_ = 0;
  std::uint32_t stale_for_ = 0;
  std::uint32_t stale_count_ = 0;
  std::uint32_t out_of_table_ = 0;
  AtomicWord<Request> request_{Request::none};
};

}  // namespace volcomp
