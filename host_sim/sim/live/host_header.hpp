#pragma once
// Guards against DNS rebinding: a request for another host comes from a page whose name now
// resolves to 127.0.0.1, and the browser would let that page read the answers.

#include <string_view>

namespace volcomp::sim {

// `host` of an HTTP request: localhost or 127.0.0.1 with the port of this server, which may only be
// missing where it is 80.
[[nodiscard]] bool names_this_server(std::string_view host, int port);

}  // namespace volcomp::sim
