#include "firmware/posix/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace volcomp::posix {
namespace {

// A path, or with a leading @ a name in the abstract namespace.
int connected_to(const char* name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t length = std::strlen(name);
  if (length == 0 || length >= sizeof address.sun_path) return -1;
  std::memcpy(address.sun_path, name, length);
  if (name[0] == '@') address.sun_path[0] = '\0';
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
  if (socket >= 0 && ::connect(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0)
    return socket;
  if (socket >= 0) ::close(socket);
  return -1;
}

}  // namespace

ServiceManager::ServiceManager() {
  const char* const name = std::getenv("NOTIFY_SOCKET");
  if (name != nullptr) socket_ = connected_to(name);
  const char* const watchdog = std::getenv("WATCHDOG_USEC");
  if (watchdog != nullptr) period_us_ = std::strtoull(watchdog, nullptr, 10) / 3;
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) ::close(socket_);
}

void ServiceManager::alive(std::uint64_t now_us) {
  if (period_us_ == 0 || now_us - told_us_ < period_us_) return;
  told_us_ = now_us;
  tell("WATCHDOG=1");
}

void ServiceManager::tell(const std::string& lines) const {
  if (socket_ >= 0) static_cast<void>(::send(socket_, lines.data(), lines.size(), MSG_NOSIGNAL));
}

}  // namespace volcomp::posix
