#pragma once
// The electronic data sheet of the compensation node (CiA 306-1), for configuration tools.

#include <string>

namespace volcomp::host {

// The whole file; the same text at every call. Objects, limits and defaults are those of the code.
[[nodiscard]] std::string make_eds();

}  // namespace volcomp::host
