#pragma once

namespace volcomp::host {

inline constexpr const char* kVersion = VOLCOMP_VERSION;

// The git revision of the sources, with "-modified" where a file differs from it; empty outside a
// checkout.
[[nodiscard]] const char* source_revision();

}  // namespace volcomp::host
