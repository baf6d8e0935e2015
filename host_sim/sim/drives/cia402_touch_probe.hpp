#pragma once
// Touch probe 1 of a drive (CiA 402-2, "touch probe functionality"): latches the position at an
// edge of the probe signal. Touch probe 2 has its objects but no input.

#include <array>
#include <cstdint>

namespace volcomp::sim {

// What one edge of one probe leaves behind.
struct TouchProbeLatch {
  std::int32_t position = 0;     // 60BAh…60BDh
  std::uint32_t time_ns = 0;     // 60D1h…60D4h: since the SYNC before it
  std::uint16_t edge_count = 0;  // 60D5h…60D8h: latched edges since power-on, wraps
};

struct TouchProbeObjects {
  std::uint16_t function = 0;                // 60B8h
  std::uint16_t status = 0;                  // 60B9h
  std::array<std::int16_t, 2> source{1, 2};  // 60D0h: the input each probe is wired to
  TouchProbeLatch positive_1;
  TouchProbeLatch negative_1;
  TouchProbeLatch positive_2;
  TouchProbeLatch negative_2;
};

// 60B8h has been written: switching a probe off forgets what it stored.
void apply_function(TouchProbeObjects& probe);

// An edge at the input of probe 1. False when nobody asked for it: probe or edge switched off, or
// a single event was wanted and has been stored.
bool latch(TouchProbeObjects& probe, bool rising, std::int32_t position, std::uint32_t time_ns);

}  // namespace volcomp::sim
