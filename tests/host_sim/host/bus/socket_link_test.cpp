// A link over SocketCAN whose sender waits until the kernel has handed a frame over, against a
// kernel played by the test: a frame that comes back is marked MSG_CONFIRM
// (Documentation/networking/can.rst, CAN_RAW_RECV_OWN_MSGS).

#include "host_sim/host/bus/links/socket_link.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <cstring>
#include <deque>
#include <vector>

#include <gmock/gmock.h>

#include "tests/complaint.hpp"
#include "tests/hal/system_calls.hpp"

namespace volcomp::host {
namespace {

using test::failing;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Heard {
  std::uint16_t id;
  bool own;
};

class SocketLinkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    calls.socket = [](int, int, int) { return ::open("/dev/null", O_RDWR | O_CLOEXEC); };
    calls.ioctl = [](int, unsigned long request, void* argument) {
      auto* const asked = static_cast<ifreq*>(argument);
      if (request == SIOCGIFINDEX) {
        asked->ifr_ifindex = 1;
      } else {
        asked->ifr_flags = IFF_UP;
      }
      return 0;
    };
    calls.setsockopt = [](int, int, int, const void*, socklen_t) { return 0; };
    calls.bind = [](int, const sockaddr*) { return 0; };
    calls.send = [](int, const void*, std::size_t size) { return static_cast<ssize_t>(size); };
    calls.recvmsg = [this](int, msghdr* message) -> ssize_t {
      if (heard.empty()) return failing(receive_error);
      can_frame raw{};
      raw.can_id = heard.front().id;
      message->msg_flags = heard.front().own ? MSG_CONFIRM : 0;
      message->msg_controllen = 0;
      heard.pop_front();
      std::memcpy(message->msg_iov->iov_base, &raw, sizeof raw);
      return ssize_t{sizeof raw};
    };
  }

  static std::vector<std::uint16_t> received_ids(SocketLink& link) {
    std::vector<std::uint16_t> ids;
    hal::CanFrame frame;
    while (link.receive(frame))
      ids.push_back(frame.id);
    return ids;
  }

  test::SystemCalls calls;
  std::deque<Heard> heard;
  int receive_error = EAGAIN;
};

TEST_F(SocketLinkTest, AFrameIsSentWhenItHasComeBackAndNoneIsLostMeanwhile) {
  SocketLink link("can0");
  link.await_echoes();
  heard = {{0x181, false}, {0x281, false}, {0x301, true}, {0x381, false}};
  ASSERT_TRUE(link.send({0x301, 0, {}}));
  EXPECT_EQ(heard.size(), 1U) << "what follows the echo is read when it is asked for";
  EXPECT_THAT(received_ids(link), ElementsAre(0x181, 0x281, 0x381));
}

TEST_F(SocketLinkTest, EveryFrameAwaitsItsOwnEcho) {
  SocketLink link("can0");
  link.await_echoes();
  heard = {{0x301, true}, {0x401, true}};
  ASSERT_TRUE(link.send({0x301, 0, {}}));
  EXPECT_EQ(heard.size(), 1U);
  ASSERT_TRUE(link.send({0x401, 0, {}}));
  EXPECT_THAT(heard, IsEmpty());
  EXPECT_THAT(received_ids(link), IsEmpty());
}

TEST_F(SocketLinkTest, WithoutEchoesNothingIsRead) {
  SocketLink link("can0");
  heard = {{0x181, false}};
  ASSERT_TRUE(link.send({0x301, 0, {}}));
  EXPECT_EQ(heard.size(), 1U);
}

TEST_F(SocketLinkTest, AFrameTheKernelRefusesHasNoEcho) {
  SocketLink link("can0");
  link.await_echoes();
  heard = {{0x181, false}};
  calls.send = [](int, const void*, std::size_t) { return ssize_t{failing(ENOBUFS)}; };
  EXPECT_FALSE(link.send({0x301, 0, {}}));
  EXPECT_EQ(heard.size(), 1U);
}

TEST_F(SocketLinkTest, AnInterfaceThatGoesDownEndsTheWait) {
  SocketLink link("can0");
  link.await_echoes();
  receive_error = ENETDOWN;
  EXPECT_THAT(sim::complaint_of([&] {
                static_cast<void>(link.send({0x301, 0, {}}));
              }),
              HasSubstr("can0: the interface is down"));
}

TEST_F(SocketLinkTest, AKernelThatGivesNoFramesBackIsNamed) {
  SocketLink link("can0");
  calls.setsockopt = [](int, int, int, const void*, socklen_t) { return failing(ENOPROTOOPT); };
  EXPECT_THAT(sim::complaint_of([&] { link.await_echoes(); }),
              HasSubstr("can0: the kernel gives no sent frames back"));
}

}  // namespace
}  // namespace volcomp::host
