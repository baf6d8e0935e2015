#pragma once
// Touch probe 1 of a drive (CiA 402-2, "touch probe functionality"): latches the position at an
// edge of the probe signal. Touch probe 2 has its objects but no input.

#include <cstdint>

#include "host_sim/host/bus/cia402_objects.hpp"

namespace volcomp::sim {

// 60B8h has been written: switching a probe off forgets what it stored.
void apply_function(host::TouchProbeObjects& probe);

// Stores an edge at the input of probe 1. False when it is ignored: probe or edge switched off, or
// the single event already stored.
bool latch(host::TouchProbeObjects& probe, bool rising, std::int32_t position,
           std::uint32_t time_ns);

}  // namespace volcomp::sim
