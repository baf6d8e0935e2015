#pragma once

namespace volcomp::host {

inline constexpr const char* kVersion = VOLCOMP_VERSION;

// Of the sources in git, with "-modified" where a file differs from it; empty outside a checkout.
[[nodiscard]] const char* source_revision();

}  // namespace volcomp::host
