#pragma once

namespace volcomp::sim {

inline constexpr const char* kVersion = VOLCOMP_VERSION;

}  // namespace volcomp::sim
