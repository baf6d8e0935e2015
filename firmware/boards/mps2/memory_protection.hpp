#pragma once
// The memory protection unit (PMSAv7, DDI 0403, B3.5): what is not listed in memory_protection.cpp
// does not exist, also for privileged code.

namespace volcomp::boards {

// Before main; from then on flash is read-only, RAM never executed, page 0 and the guard below the
// stack forbidden.
void protect_memory();

}  // namespace volcomp::boards
