#pragma once

#include <string_view>

namespace volcomp::host {

// Whether the bytes are UTF-8 (RFC 3629, section 4): no stray or missing continuation, no longer
// form than needed, no surrogate, nothing beyond U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace volcomp::host
