#pragma once
// The memory management unit (Arm DDI 0487, D5), identity mapping: what is not listed in
// memory_map.cpp does not exist.

namespace volcomp::boards {

// Before main, once; from then on code and constants are read-only, no other memory is executable,
// page 0 and the guard below each stack do not exist, and the caches are on.
void map_memory();

}  // namespace volcomp::boards
