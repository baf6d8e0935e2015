#include "host_sim/sim/live/host_header.hpp"

#include <algorithm>
#include <string>

namespace volcomp::sim {

bool names_this_server(std::string_view host, int port) {
  constexpr int kPortOfHttp = 80;
  const auto colon = host.find(':');
  std::string name(host.substr(0, colon));
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (name != "localhost" && name != "127.0.0.1") return false;
  if (colon == std::string_view::npos) return port == kPortOfHttp;
  return host.substr(colon + 1) == std::to_string(port);
}

}  // namespace volcomp::sim
