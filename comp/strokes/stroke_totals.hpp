#pragma once
// The sums over all passes that counted, and how they are shared out to the two tables of C
// (docs/papers/internal-helical.md). Background only.

#include <cmath>

#include "comp/strokes/spectral_line.hpp"
#include "comp/strokes/stroke_pass.hpp"

namespace volcomp {

// All passes that counted since the last clear().
template <std::size_t Nodes, std::size_t Slots>
class StrokeTotals {
 public:
  // Refused, and nothing added: pass_discarded (value = share of bad frames) above 1 %,
  // too_few_points for a pass without samples, bad_setting ("slot", "direction").
  Status add(const StrokePass<Nodes>& pass) {
    if (const Status s = check(pass); !s.ok()) return s;
    NodeSums all;
    for (std::size_t j = 0; j < Nodes; ++j) {
      const NodeSums node = pass.node(j);
      all.n += node.n;
      all.sum += node.sum;
    }
    if (all.n == 0) return refuse(Reason::too_few_points);
    const double mean = all.sum / static_cast<double>(all.n);
    Side& side = side_[static_cast<std::size_t>(pass.direction)];
    side.means.add(mean);
    side.slot[pass.slot].add(mean);
    for (std::size_t j = 0; j < Nodes; ++j)
      add_shifted(side.node[j], pass.node(j), -mean);
    for (std::size_t k = 0; k < kFlankSignals; ++k)
      side.spectra.signal[k].merge(pass.spectra.signal[k]);
    for (std::size_t k = 0; k < kMostLines; ++k) {
      side.spectra.order[k].merge(pass.spectra.order[k]);
      const double amplitude = spectral_line(pass.time[k]).amplitude;
      side.time_squares[k] += amplitude * amplitude;
    }
    ++side.passes;
    return {};
  }

  // In place: a copy would not fit the stack of a small board.
  void clear() {
    for (Side& side : side_) {
      for (NodeSums& node : side.node)
        node = {};
      for (NodeSums& slot : side.slot)
        slot = {};
      side.means = {};
      side.spectra = {};
      side.time_squares = {};
      side.passes = 0;
    }
  }

  // --- what the learning of the two tables of C starts from. The mean of a slot against that of
  // its direction belongs to the slot table T2, the rest to the stroke tables T1; with both taking
  // all, the constant would be learned twice.

  void stroke_sums(Direction direction, Span<NodeSums> out) const {
    const Side& side = side_[static_cast<std::size_t>(direction)];
    const double mean = mean_of(side);
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[j] = {};
      add_shifted(out[j], side.node[j], mean);
    }
  }

  void slot_sums(Span<NodeSums> out) const {
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = {};
      for (const Side& side : side_)
        add_shifted(out[k], side.slot[k], -mean_of(side));
    }
  }

  [[nodiscard]] std::uint32_t passes(Direction direction) const {
    return side_[static_cast<std::size_t>(direction)].passes;
  }
  [[nodiscard]] const StrokeSpectra& spectra(Direction direction) const {
    return side_[static_cast<std::size_t>(direction)].spectra;
  }
  // Root mean square over the passes of the amplitude of a time line, µm.
  [[nodiscard]] double time_amplitude(Direction direction, std::size_t line) const {
    const Side& side = side_[static_cast<std::size_t>(direction)];
    if (side.passes == 0) return 0.0;
    return std::sqrt(side.time_squares[line] / static_cast<double>(side.passes));
  }

 private:
  struct Side {
    std::array<NodeSums, Nodes> node{};  // the mean of each pass taken out
    std::array<NodeSums, Slots> slot{};  // of the means of passes
    NodeSums means{};
    StrokeSpectra spectra{};
    std::array<double, kMostLines> time_squares{};
    std::uint32_t passes = 0;
  };

  static Status check(const StrokePass<Nodes>& pass) {
    constexpr double kMostBad = 0.01;
    Where where;
    if (pass.slot >= Slots) where.field = "slot";
    if (pass.direction == Direction::unknown) where.field = "direction";
    if (where.field != nullptr) return refuse(Reason::bad_setting, where);
    where.has_value = true;
    where.value = pass.frames == 0 ? 0.0 : static_cast<double>(pass.bad) / pass.frames;
    return where.value > kMostBad ? refuse(Reason::pass_discarded, where) : Status{};
  }

  static double mean_of(const Side& side) {
    return side.means.n == 0 ? 0.0 : side.means.sum / static_cast<double>(side.means.n);
  }

  // Adds samples that are all `shift` larger than those behind `more`.
  static void add_shifted(NodeSums& to, const NodeSums& more, double shift) {
    const auto n = static_cast<double>(more.n);
    to.n += more.n;
    to.sum += more.sum + n * shift;
    to.sum_squares += more.sum_squares + shift * (2.0 * more.sum + n * shift);
  }

  std::array<Side, 2> side_{};
};

}  // namespace volcomp
