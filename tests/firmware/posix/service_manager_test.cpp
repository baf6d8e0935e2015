// sd_notify(3): a datagram of lines to the socket that NOTIFY_SOCKET names.

#include "firmware/posix/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace volcomp::posix {
namespace {

// A service manager whose socket has a name in the abstract namespace.
class Manager : public testing::Test {
 protected:
  Manager() {
    name_ = "@volcomp-test-" + std::to_string(::getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + 1, name_.data() + 1, name_.size() - 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ::setenv("NOTIFY_SOCKET", name_.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "300000", 1);
  }
  ~Manager() override {
    ::close(socket_);
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }

  // "" when nothing was said.
  [[nodiscard]] std::string heard() const {
    std::array<char, 256> text{};
    const ssize_t size = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0U};
  }

 private:
  int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::string name_;
};

TEST_F(Manager, IsToldTheStates) {
  const ServiceManager manager;
  manager.ready("node 32 on can0");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=node 32 on can0");
  manager.status("waits");
  EXPECT_EQ(heard(), "STATUS=waits");
  manager.stopping();
  EXPECT_EQ(heard(), "STOPPING=1");
}

// A third of the time that it waits.
TEST_F(Manager, IsToldThatTheLoopRunsAsOftenAsItNeeds) {
  ServiceManager manager;
  manager.alive(50'000);
  EXPECT_EQ(heard(), "");
  manager.alive(100'000);
  EXPECT_EQ(heard(), "WATCHDOG=1");
  manager.alive(199'999);
  EXPECT_EQ(heard(), "");
  manager.alive(200'000);
  EXPECT_EQ(heard(), "WATCHDOG=1");
}

TEST_F(Manager, ThatWantsNoSignsOfLifeGetsNone) {
  ::unsetenv("WATCHDOG_USEC");
  ServiceManager manager;
  manager.alive(10'000'000);
  EXPECT_EQ(heard(), "");
}

TEST_F(Manager, ThatIsNotThereChangesNothing) {
  for (const char* const name : {"", "/none/such", "@"}) {
    ::setenv("NOTIFY_SOCKET", name, 1);
    ServiceManager manager;
    manager.ready("x");
    manager.alive(1'000'000);
  }
  EXPECT_EQ(heard(), "");
}

}  // namespace
}  // namespace volcomp::posix
