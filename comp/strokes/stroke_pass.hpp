#pragma once
// One pass of the wheel through the face: everything the monitor stores about it.

#include <array>

#include "comp/strokes/helix_tick.hpp"
#include "comp/strokes/learning.hpp"
#include "comp/strokes/running_statistics.hpp"

namespace volcomp {

inline constexpr std::size_t kMostLines = 4;

enum class FlankSignal : std::uint8_t { sync, lag_c, x };
inline constexpr std::size_t kFlankSignals = 3;

// Statistics, order lines along Z and time lines of the synchronisation signal, µm on the flank.
struct StrokeSpectra {
  std::array<RunningStatistics, kFlankSignals> signal{};
  std::array<OrderLine, kMostLines> order{};

  [[nodiscard]] RunningStatistics& of(FlankSignal s) { return signal[static_cast<std::size_t>(s)]; }
  [[nodiscard]] const RunningStatistics& of(FlankSignal s) const {
    return signal[static_cast<std::size_t>(s)];
  }
};

template <std::size_t Nodes>
class StrokePass {
 public:
  StrokeSpectra spectra{};
  std::array<TimeLine, kMostLines> time{};
  std::uint16_t slot = 0;
  Direction direction = Direction::unknown;
  std::uint32_t frames = 0;  // in the face
  std::uint32_t bad = 0;     // of them not usable

  // Empty, in place, in a time that hardly depends on the number of nodes: what they hold counts
  // only once this pass has been there.
  void begin(std::uint16_t of_slot, Direction along,
             const std::array<TimeLine, kMostLines>& lines) {
    visited_ = {};
    spectra = {};
    time = lines;
    slot = of_slot;
    direction = along;
    frames = bad = 0;
  }

  // A sample of e_s, rad, at a node.
  void add(std::size_t j, double value) {
    std::uint32_t& word = visited_[j / 32U];
    const std::uint32_t bit = 1U << (j % 32U);
    if ((word & bit) == 0) node_[j] = {};
    word |= bit;
    node_[j].add(value);
  }
  [[nodiscard]] NodeSums node(std::size_t j) const {
    return (visited_[j / 32U] >> (j % 32U) & 1U) != 0 ? node_[j] : NodeSums{};
  }

 private:
  std::array<NodeSums, Nodes> node_{};  // by command position
  std::array<std::uint32_t, (Nodes + 31) / 32> visited_{};
};

}  // namespace volcomp
