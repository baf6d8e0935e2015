#pragma once
// One pass of the wheel through the face: everything the monitor keeps of it. Seed 003 section 8.

#include <array>

#include "comp/realtime/helix_tick.hpp"
#include "comp/realtime/running_statistics.hpp"
#include "comp/tables/learning.hpp"

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
struct StrokePass {
  std::array<NodeSums, Nodes> node{};  // of e_s, rad, by command position
  StrokeSpectra spectra{};
  std::array<TimeLine, kMostLines> time{};
  std::uint16_t slot = 0;
  Direction direction = Direction::unknown;
  std::uint32_t frames = 0;  // in the face
  std::uint32_t bad = 0;     // of them not usable

  // Empty, in place.
  void begin(std::uint16_t of_slot, Direction along,
             const std::array<TimeLine, kMostLines>& lines) {
    for (NodeSums& sums : node)
      sums = {};
    spectra = {};
    time = lines;
    slot = of_slot;
    direction = along;
    frames = bad = 0;
  }
};

}  // namespace volcomp
