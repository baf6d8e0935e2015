#pragma once
// Watches a machine grind helical slots: what tracking errors of Z, C and X leave on the flank,
// by stroke direction, node of the stroke and slot. O(1) per tick and signal. See
// docs/papers/internal-helical.md.
//
// The interrupt calls tick() only. A pass ends when the wheel leaves the face; it then waits in the
// spare half of a double buffer until the background collects it. A pass that ends while another
// still waits is lost and counted.

#include "comp/core/atomic_word.hpp"
#include "comp/machine/fixed_trig.hpp"
#include "comp/strokes/stroke_pass.hpp"
#include "comp/strokes/stroke_totals.hpp"

namespace volcomp {

struct HelixMonitorSettings {
  double turn_per_mm = 0.0;    // 1/p, signed, rad/mm (InternalGear::turn_per_mm)
  double flank_per_rad = 0.0;  // r_b cos β_b, mm/rad (InternalGear::normal_lever())
  double flank_per_x = 0.0;    // |dn| per X error at the pitch circle
  std::int32_t tick_ns = 1'000'000;
  std::int32_t most_skew_ns = 2'000'000;  // positions are interpolated to one instant; beyond: not
                                          // used. 1 ms uncorrected is 3.3 µm at 13.4 mm/s
  std::int64_t z0_nm = 0;                 // first node of the stroke
  std::uint32_t node_pitch_nm = 250'000;
  std::size_t nodes = 2;
  std::array<double, kMostLines> time_line_hz{};         // 0: unused
  std::array<double, kMostLines> order_wavelength_mm{};  // along Z; 0: unused
};

template <std::size_t Nodes, std::size_t Slots>
class HelixMonitor {
 public:
  using Totals = StrokeTotals<Nodes, Slots>;

  // Forgets everything. Only while no tick can come. Refused: not_finite and bad_setting (field),
  // too_few_knots, too_many_knots, travel_too_long.
  Status configure(const HelixMonitorSettings& settings) {
    if (const Status s = check(settings); !s.ok()) return s;
    settings_ = settings;
    const HelixGains gains{static_cast<float>(settings.turn_per_mm / kNmPerMm),
                           static_cast<float>(settings.flank_per_rad * kUmPerMm),
                           static_cast<float>(settings.flank_per_x)};
    tracker_ = HelixTracker(gains, settings.tick_ns, settings.most_skew_ns);
    for (std::size_t k = 0; k < kMostLines; ++k) {
      lines_[k] = time_line(settings.time_line_hz[k] * settings.tick_ns * 1e-9);
      turns_[k] = turns_per_nm(settings.order_wavelength_mm[k]);
    }
    totals_.clear();
    uses_ = {};
    signals_ = {};
    lost_ = outside_ = 0;
    filling_ = 0;
    in_pass_ = false;
    waiting_.store(0, std::memory_order_relaxed);
    return {};
  }

  // --- interrupt

  FrameUse tick(const HelixFrame& frame) {
    const FrameUse use = tracker_.take(frame, signals_);
    count(uses_[static_cast<std::size_t>(use)]);
    if (in_pass_ && ends_pass(frame)) end_pass();
    if (!frame.in_face) return use;
    if (!in_pass_) begin_pass(frame);
    record(frame, use == FrameUse::used);
    return use;
  }

  // Signals of the last frame that was used.
  [[nodiscard]] const HelixSignals& signals() const { return signals_; }

  // --- background

  [[nodiscard]] bool pass_waits() const { return waiting_.load(std::memory_order_acquire) != 0; }

  // Takes the pass that waits into the totals, or discards it with the reason: see
  // StrokeTotals::add(). Without one: too_few_points.
  Status collect() {
    if (!pass_waits()) return refuse(Reason::too_few_points);
    const Status status = totals_.add(pass_[1U - filling_]);
    waiting_.store(0, std::memory_order_release);
    return status;
  }

  [[nodiscard]] Totals& totals() { return totals_; }
  [[nodiscard]] const Totals& totals() const { return totals_; }
  // Saturating counters.
  [[nodiscard]] std::uint32_t frames(FrameUse use) const {
    return uses_[static_cast<std::size_t>(use)];
  }
  [[nodiscard]] std::uint32_t passes_lost() const { return lost_; }
  [[nodiscard]] std::uint32_t outside() const { return outside_; }  // samples beyond the nodes

 private:
  static constexpr std::uint32_t kMostMissed = 64;

  static void count(std::uint32_t& counter) {
    if (counter < UINT32_MAX) ++counter;
  }

  // 2^64 turns per nm: what a position in nm, multiplied modulo 2^64, makes of a wavelength is the
  // phase, exact over the whole range.
  static std::uint64_t turns_per_nm(double wavelength_mm) {
    if (!(wavelength_mm > 0.0)) return 0;
    return static_cast<std::uint64_t>(18446744073709551616.0 / (wavelength_mm * kNmPerMm));
  }

  static Status check(const HelixMonitorSettings& s) {
    Where where;
    where.count = static_cast<int>(s.nodes);
    if (s.nodes < 2) return refuse(Reason::too_few_knots, where);
    if (s.nodes > Nodes) return refuse(Reason::too_many_knots, where);
    where.count = -1;
    if (!std::isfinite(s.turn_per_mm)) where.field = "turn_per_mm";
    if (!std::isfinite(s.flank_per_rad)) where.field = "flank_per_rad";
    if (!std::isfinite(s.flank_per_x)) where.field = "flank_per_x";
    if (where.field != nullptr) return refuse(Reason::not_finite, where);
    if (!(s.flank_per_rad > 0.0)) where.field = "flank_per_rad";
    if (s.tick_ns < 1) where.field = "tick_ns";
    if (s.most_skew_ns < 0) where.field = "most_skew_ns";
    if (s.node_pitch_nm < 1) where.field = "node_pitch_nm";
    for (std::size_t k = 0; k < kMostLines; ++k) {
      where.index = static_cast<int>(k);
      const double turns = s.time_line_hz[k] * s.tick_ns * 1e-9;
      if (!(turns >= 0.0 && turns < 0.5)) where.field = "time_line_hz";
      const double wavelength = s.order_wavelength_mm[k];
      if (!(wavelength >= 0.0 && wavelength < 1e6) || (wavelength > 0.0 && wavelength < 1e-3))
        where.field = "order_wavelength_mm";
      if (where.field != nullptr) return refuse(Reason::bad_setting, where);
    }
    const std::uint64_t length = std::uint64_t{s.node_pitch_nm} * s.nodes;
    return length > UINT32_MAX ? refuse(Reason::travel_too_long) : Status{};
  }

  [[nodiscard]] bool ends_pass(const HelixFrame& frame) const {
    const StrokePass<Nodes>& pass = pass_[filling_];
    return !frame.in_face || frame.slot != pass.slot || frame.stroke != pass.direction;
  }

  void begin_pass(const HelixFrame& frame) {
    pass_[filling_].begin(frame.slot, frame.stroke, lines_);
    in_pass_ = true;
  }

  void end_pass() {
    in_pass_ = false;
    if (waiting_.load(std::memory_order_acquire) != 0) return count(lost_);
    filling_ = 1U - filling_;
    waiting_.store(1, std::memory_order_release);
  }

  void record(const HelixFrame& frame, bool usable) {
    StrokePass<Nodes>& pass = pass_[filling_];
    const std::uint32_t missed = tracker_.missed();
    pass.frames += 1U + missed;
    pass.bad += missed + (usable ? 0U : 1U);
    const auto sync = static_cast<double>(signals_.sync_um);
    // A sample that is missing is the one after or before: time goes on. Where more are missing,
    // the pass will not count.
    const std::uint32_t times = 1U + (missed < kMostMissed ? missed : kMostMissed);
    for (std::uint32_t i = 0; i < times; ++i) {
      for (TimeLine& line : pass.time)
        line.add(sync);
    }
    if (!usable) return;
    pass.spectra.of(FlankSignal::sync).add(sync);
    pass.spectra.of(FlankSignal::lag_c).add(static_cast<double>(signals_.lag_c_um));
    pass.spectra.of(FlankSignal::x).add(static_cast<double>(signals_.x_um));
    add_to_node(pass, frame.z.command);
    for (std::size_t k = 0; k < kMostLines; ++k) {
      if (turns_[k] == 0) continue;
      const std::uint64_t phase = static_cast<std::uint64_t>(frame.z.command) * turns_[k];
      const SineCosine at = sine_cosine(static_cast<std::uint32_t>(phase >> 32U));
      pass.spectra.order[k].add(sync, static_cast<double>(at.cosine), static_cast<double>(at.sine));
    }
  }

  void add_to_node(StrokePass<Nodes>& pass, std::int64_t z) {
    const std::uint32_t half = settings_.node_pitch_nm / 2U;
    const std::uint64_t from_edge =
        static_cast<std::uint64_t>(z) - static_cast<std::uint64_t>(settings_.z0_nm) + half;
    const auto length = static_cast<std::uint32_t>(settings_.node_pitch_nm *
                                                   static_cast<std::uint32_t>(settings_.nodes));
    if (from_edge >= length) return count(outside_);
    const std::uint32_t j = static_cast<std::uint32_t>(from_edge) / settings_.node_pitch_nm;
    pass.add(j, static_cast<double>(signals_.e_s_rad));
  }

  HelixMonitorSettings settings_{};
  HelixTracker tracker_{};
  HelixSignals signals_{};
  std::array<TimeLine, kMostLines> lines_{};
  std::array<StrokePass<Nodes>, 2> pass_{};
  std::array<std::uint64_t, kMostLines> turns_{};
  std::array<std::uint32_t, kFrameUses> uses_{};
  std::uint32_t lost_ = 0;
  std::uint32_t outside_ = 0;
  std::size_t filling_ = 0;
  bool in_pass_ = false;
  AtomicWord<> waiting_{0};
  Totals totals_{};
};

}  // namespace volcomp
