// SocketCAN against a kernel played by the test: its answers by the manual pages and the kernel's
// CAN documentation (Documentation/networking/can.rst; errors of packet(7), send(2)).

#include "hal/linux/socket_can.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <string>

#include "hal/linux/lasting_can.hpp"
#include "tests/hal/support.hpp"
#include "tests/hal/system_calls.hpp"

namespace volcomp::test {
namespace {

using hal::OpenResult;
using hal::SocketCan;

constexpr int kInterfaceIndex = 7;

can_frame raw_frame(canid_t id, std::uint8_t size = 0) {
  can_frame raw{};
  raw.can_id = id;
  raw.can_dlc = size;
  for (std::uint8_t i = 0; i < CAN_MAX_DLEN; ++i)
    raw.data[i] = static_cast<std::uint8_t>(0xA0 + i);
  return raw;
}

// A kernel with CAN and one interface that is up.
class KernelWithCan : public ::testing::Test {
 protected:
  void SetUp() override {
    calls.socket = [](int domain, int, int protocol) {
      EXPECT_EQ(domain, PF_CAN);
      EXPECT_EQ(protocol, CAN_RAW);
      return ::open("/dev/null", O_RDWR | O_CLOEXEC);  // a descriptor that can be closed
    };
    calls.ioctl = [this](int, unsigned long request, void* argument) {
      auto* const asked = static_cast<ifreq*>(argument);
      const int error = request == SIOCGIFINDEX ? index_error : flags_error;
      if (error != 0) return failing(error);
      if (request == SIOCGIFINDEX) {
        EXPECT_STREQ(asked->ifr_name, "can0");
        asked->ifr_ifindex = kInterfaceIndex;
      } else {
        asked->ifr_flags = flags;
      }
      return 0;
    };
    calls.setsockopt = [](int, int, int, const void*, socklen_t) { return 0; };
    calls.bind = [](int, const sockaddr* address) {
      sockaddr_can can{};
      std::memcpy(&can, address, sizeof can);
      EXPECT_EQ(can.can_family, AF_CAN);
      EXPECT_EQ(can.can_ifindex, kInterfaceIndex);
      return 0;
    };
    calls.recvmsg = [this](int, msghdr* message) -> ssize_t {
      if (heard.empty()) return failing(receive_error);
      const std::size_t size = message->msg_iov->iov_len;
      std::memcpy(message->msg_iov->iov_base, &heard.front(), size);
      heard.pop_front();
      message->msg_flags = heard_own ? MSG_CONFIRM : 0;
      tell_drops(*message);
      return static_cast<ssize_t>(size);
    };
  }

  void expect_refused(OpenResult result, int error, const char* name = "can0") {
    const hal::OpenStatus status = port.open(name);
    EXPECT_EQ(status.result, result) << name;
    EXPECT_EQ(status.error_number, error) << name;
    EXPECT_EQ(port.descriptor(), -1) << "closed";
  }

  // socket(7), SO_RXQ_OVFL: the kernel adds its counter once it is not 0.
  void tell_drops(msghdr& message) const {
    if (drops == 0) {
      message.msg_controllen = 0;
      return;
    }
    cmsghdr* const told = CMSG_FIRSTHDR(&message);
    told->cmsg_level = SOL_SOCKET;
    told->cmsg_type = SO_RXQ_OVFL;
    told->cmsg_len = CMSG_LEN(sizeof drops);
    std::memcpy(CMSG_DATA(told), &drops, sizeof drops);
    message.msg_controllen = CMSG_SPACE(sizeof drops);
  }

  SystemCalls calls;
  std::uint32_t drops = 0;  // of the socket so far
  short flags = IFF_UP;
  int index_error = 0;
  int flags_error = 0;
  int receive_error = EAGAIN;
  std::deque<can_frame> heard;
  bool heard_own = false;
  SocketCan port;
};

// --- opening

TEST_F(KernelWithCan, AnInterfaceThatIsUpIsOpened) {
  ASSERT_TRUE(port.open("can0").ok());
  EXPECT_GE(port.descriptor(), 0);
  EXPECT_FALSE(port.network_down());
  EXPECT_TRUE(port.wait(0)) << "what can be read ends the wait";
  port.close();
  EXPECT_EQ(port.descriptor(), -1);
}

TEST_F(KernelWithCan, AKernelWithoutCanIsToldFromOneThatHasNoDescriptorLeft) {
  for (const int error : {EAFNOSUPPORT, EPROTONOSUPPORT}) {
    calls.socket = [error](int, int, int) { return failing(error); };
    expect_refused(OpenResult::no_can_in_kernel, error);
  }
  calls.socket = [](int, int, int) { return failing(EMFILE); };
  expect_refused(OpenResult::failed, EMFILE);
}

TEST_F(KernelWithCan, AnInterfaceThatIsNotThere) {
  expect_refused(OpenResult::no_such_interface, ENAMETOOLONG, "sixteen-letters!");
  index_error = ENODEV;
  expect_refused(OpenResult::no_such_interface, ENODEV);
  index_error = 0;
  flags_error = ENODEV;  // removed between the two questions
  expect_refused(OpenResult::no_such_interface, ENODEV);
}

TEST_F(KernelWithCan, AnInterfaceThatIsDown) {
  flags = 0;
  expect_refused(OpenResult::interface_down, ENETDOWN);
}

// raw(7): an interface of another kind answers ENODEV.
TEST_F(KernelWithCan, AnInterfaceOfAnotherKind) {
  calls.bind = [](int, const sockaddr*) { return failing(ENODEV); };
  expect_refused(OpenResult::not_a_can_interface, ENODEV);
  calls.bind = [](int, const sockaddr*) { return failing(EPERM); };
  expect_refused(OpenResult::failed, EPERM);
}

// Without error reports a bus-off would not be seen; smaller buffers do no harm.
TEST_F(KernelWithCan, ErrorReportsAreNeededLargeBuffersAreNot) {
  calls.setsockopt = [](int, int level, int, const void*, socklen_t) {
    return level == SOL_SOCKET ? failing(ENOBUFS) : 0;
  };
  EXPECT_TRUE(port.open("can0").ok());
  calls.setsockopt = [](int, int level, int name, const void*, socklen_t) {
    return level == SOL_CAN_RAW && name == CAN_RAW_ERR_FILTER ? failing(ENOPROTOOPT) : 0;
  };
  expect_refused(OpenResult::failed, ENOPROTOOPT);
}

// --- frames

TEST_F(KernelWithCan, AFrameIsSentAsTheKernelWantsIt) {
  ASSERT_TRUE(port.open("can0").ok());
  std::vector<can_frame> sent;
  calls.send = [&](int, const void* bytes, std::size_t size) {
    EXPECT_EQ(size, CAN_MTU);
    std::memcpy(&sent.emplace_back(), bytes, sizeof(can_frame));
    return static_cast<ssize_t>(size);
  };
  ASSERT_TRUE(port.send(frame(0x7FF, {1, 2, 3})));
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].can_id, 0x7FFU);
  EXPECT_EQ(sent[0].can_dlc, 3);
  const std::array<std::uint8_t, 8> data{1, 2, 3, 0, 0, 0, 0, 0};
  EXPECT_TRUE(std::equal(data.begin(), data.end(), std::begin(sent[0].data)));
}

TEST_F(KernelWithCan, FramesThatCanopenHasNoUseForAreCountedAndLeftOut) {
  ASSERT_TRUE(port.open("can0").ok());
  // The kernel's error reports set flags of their own in the identifier; one may look extended.
  heard = {raw_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8), raw_frame(CAN_EFF_FLAG | 0x12345, 1),
           raw_frame(CAN_RTR_FLAG | 0x701), raw_frame(CAN_ERR_FLAG | CAN_EFF_FLAG, 8),
           raw_frame(0x123, 2)};
  EXPECT_EQ(receive_all(port), std::vector<hal::CanFrame>{frame(0x123, {0xA0, 0xA1})});
  EXPECT_EQ(port.skipped().error, 2U);
  EXPECT_EQ(port.skipped().extended, 1U);
  EXPECT_EQ(port.skipped().remote, 1U);
  EXPECT_FALSE(port.network_down()) << "nothing there is no failure";
}

TEST_F(KernelWithCan, NoMoreThanEightBytesAreTaken) {
  ASSERT_TRUE(port.open("can0").ok());
  heard = {raw_frame(0x123, 15)};
  hal::CanFrame got;
  ASSERT_TRUE(port.receive(got));
  EXPECT_EQ(got.size, 8);
  EXPECT_EQ(got.data[7], 0xA7);
}

// So that a babbling neighbour cannot keep the node from its work.
TEST_F(KernelWithCan, AFloodOfUselessFramesEndsACall) {
  ASSERT_TRUE(port.open("can0").ok());
  heard.assign(SocketCan::kMaxSkippedAtOnce, raw_frame(CAN_EFF_FLAG | 1));
  heard.push_back(raw_frame(0x123));
  hal::CanFrame got = frame(0x55);
  EXPECT_FALSE(port.receive(got));
  EXPECT_EQ(got, frame(0x55));
  EXPECT_TRUE(port.receive(got));
  EXPECT_EQ(got.id, 0x123);
}

TEST_F(KernelWithCan, ANetworkThatGoesDownShowsAndComesBack) {
  ASSERT_TRUE(port.open("can0").ok());
  hal::CanFrame got;
  for (const int error : {ENETDOWN, ENODEV, ENXIO}) {
    receive_error = error;
    EXPECT_FALSE(port.receive(got));
    EXPECT_TRUE(port.network_down()) << error;
    heard = {raw_frame(0x123)};
    EXPECT_TRUE(port.receive(got));
    EXPECT_FALSE(port.network_down()) << error;
  }
}

TEST_F(KernelWithCan, DroppedFramesAreTakenOnceAlsoWhenTheCounterWraps) {
  ASSERT_TRUE(port.open("can0").ok());
  const auto losses_after = [this](std::uint32_t counter) {
    heard = {raw_frame(0x123)};
    drops = counter;
    hal::CanFrame got;
    EXPECT_TRUE(port.receive(got));
    return port.take_losses();
  };
  EXPECT_EQ(losses_after(0), 0U);
  EXPECT_EQ(losses_after(5), 5U);
  EXPECT_EQ(port.take_losses(), 0U);
  EXPECT_EQ(losses_after(0xFFFF'FFFF), 0xFFFF'FFFAU);
  EXPECT_EQ(losses_after(2), 3U);
  ASSERT_TRUE(port.open("can0").ok());  // another socket counts from 0
  EXPECT_EQ(losses_after(1), 1U);
}

// --- filters (Documentation/networking/can.rst, CAN_RAW_FILTER)

TEST_F(KernelWithCan, FiltersAreExactIdentifiersOf11Bits) {
  ASSERT_TRUE(port.open("can0").ok());
  std::vector<can_filter> set;
  calls.setsockopt = [&](int, int level, int name, const void* value, socklen_t size) {
    EXPECT_EQ(level, SOL_CAN_RAW);
    EXPECT_EQ(name, CAN_RAW_FILTER);
    set.resize(size / sizeof(can_filter));
    std::memcpy(set.data(), value, size);
    return 0;
  };
  const std::array<std::uint16_t, 2> ids{0x000, 0x620};
  ASSERT_TRUE(port.hear_only(ids));
  ASSERT_EQ(set.size(), 2U);
  // The kernel takes a frame when id and mask agree: no 29-bit id, no remote request passes.
  const auto passes = [&set](canid_t id) {
    return std::any_of(set.begin(), set.end(), [id](const can_filter& filter) {
      return (id & filter.can_mask) == (filter.can_id & filter.can_mask);
    });
  };
  EXPECT_TRUE(passes(0x000));
  EXPECT_TRUE(passes(0x620));
  EXPECT_FALSE(passes(0x621));
  EXPECT_FALSE(passes(0x620 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(0x620 | CAN_RTR_FLAG));
  const std::array<std::uint16_t, SocketCan::kMostFilters + 1> too_many{};
  EXPECT_FALSE(port.hear_only(too_many));
  calls.setsockopt = [](int, int, int, const void*, socklen_t) { return failing(ENOMEM); };
  EXPECT_FALSE(port.hear_only(ids));
}

// --- own frames (Documentation/networking/can.rst, CAN_RAW_RECV_OWN_MSGS; MSG_CONFIRM)

TEST_F(KernelWithCan, OwnFramesComeBackMarked) {
  ASSERT_TRUE(port.open("can0").ok());
  int asked = 0;
  calls.setsockopt = [&](int, int level, int name, const void* value, socklen_t size) {
    std::uint32_t on = 0;
    EXPECT_EQ(size, sizeof on);
    std::memcpy(&on, value, sizeof on);
    asked += level == SOL_CAN_RAW && name == CAN_RAW_RECV_OWN_MSGS && on == 1 ? 1 : 0;
    return 0;
  };
  EXPECT_TRUE(port.hear_own());
  EXPECT_EQ(asked, 1);
  hal::CanFrame got;
  heard = {raw_frame(0x301)};
  heard_own = true;
  ASSERT_TRUE(port.receive(got));
  EXPECT_TRUE(port.own());
  heard = {raw_frame(0x301)};
  heard_own = false;
  ASSERT_TRUE(port.receive(got));
  EXPECT_FALSE(port.own());
  calls.setsockopt = [](int, int, int, const void*, socklen_t) { return failing(ENOPROTOOPT); };
  EXPECT_FALSE(port.hear_own());
}

// --- error reports (linux/can/error.h)

TEST_F(KernelWithCan, ErrorReportsTellTheStateOfTheController) {
  struct Report {
    canid_t flags;
    std::uint8_t controller;  // data[1]
    hal::CanBusState state;
  };
  using State = hal::CanBusState;
  const std::vector<Report> reports{
      {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, State::warning},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW, State::warning},  // names no state
      {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, State::passive},
      {CAN_ERR_ACK, CAN_ERR_CRTL_ACTIVE, State::passive},  // no report of the controller
      {CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, State::active},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_TX_WARNING, State::passive},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING, State::warning},
      {CAN_ERR_BUSOFF, 0, State::off},
      {CAN_ERR_RESTARTED, 0, State::active},
      {CAN_ERR_BUSOFF | CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, State::off}};
  ASSERT_TRUE(port.open("can0").ok());
  EXPECT_EQ(port.bus_state(), State::active);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | reports[i].flags;
    raw.can_dlc = CAN_ERR_DLC;
    raw.data[1] = reports[i].controller;
    heard = {raw};
    EXPECT_TRUE(receive_all(port).empty());
    EXPECT_EQ(port.bus_state(), reports[i].state) << i;
  }
  EXPECT_EQ(port.take_errors(), 8U) << "neither active again nor restarted";
  EXPECT_EQ(port.take_errors(), 0U);
  port.close();
  EXPECT_EQ(port.bus_state(), State::active);
}

// --- an interface that goes and comes (net/can/raw.c: ENODEV once, nothing afterwards)

class InterfaceThatGoes : public KernelWithCan {
 protected:
  using News = hal::LastingCan::News;

  void SetUp() override {
    KernelWithCan::SetUp();
    ASSERT_TRUE(lasting.open("can0").ok());
    ASSERT_EQ(lasting.supervise(0), News::none);
  }
  void turn() {
    while (lasting.receive(got)) {
    }
    receive_error = EAGAIN;
  }

  hal::CanFrame got;
  hal::LastingCan lasting;
};

TEST_F(InterfaceThatGoes, IsOpenedAgainAndBothAreToldOnce) {
  receive_error = index_error = ENODEV;
  int told = 0;
  for (std::uint64_t now_us = 0; now_us < 2'000'000; now_us += 1000) {
    turn();
    const News news = lasting.supervise(now_us);
    EXPECT_NE(news, News::back);
    told += news == News::lost ? 1 : 0;
    EXPECT_FALSE(lasting.send(frame(0x701)));
  }
  EXPECT_EQ(told, 1);
  index_error = 0;  // there, but not up
  flags = 0;
  EXPECT_EQ(lasting.supervise(3'000'000), News::none);
  flags = IFF_UP;
  EXPECT_EQ(lasting.supervise(3'000'000 + hal::LastingCan::kRetry_us), News::back);
  heard = {raw_frame(0x123)};
  EXPECT_TRUE(lasting.receive(got));
  EXPECT_EQ(lasting.supervise(9'000'000), News::none);
}

TEST_F(InterfaceThatGoes, IsAskedForNoMoreThanFiveTimesASecond) {
  receive_error = index_error = ENODEV;
  int asked = 0;
  const auto ioctl = calls.ioctl;
  calls.ioctl = [&](int fd, unsigned long request, void* argument) {
    ++asked;
    return ioctl(fd, request, argument);
  };
  for (std::uint64_t now_us = 0; now_us <= 1'000'000; now_us += 1000) {
    turn();
    static_cast<void>(lasting.supervise(now_us));
  }
  EXPECT_EQ(asked, 5);
}

TEST_F(KernelWithCan, AFullQueueIsNoNetworkDown) {
  ASSERT_TRUE(port.open("can0").ok());
  int error = ENOBUFS;
  calls.send = [&](int, const void*, std::size_t size) {
    return error == 0 ? static_cast<ssize_t>(size) : ssize_t{failing(error)};
  };
  EXPECT_FALSE(port.send(frame(0x123)));
  EXPECT_FALSE(port.network_down());
  error = ENETDOWN;
  EXPECT_FALSE(port.send(frame(0x123)));
  EXPECT_TRUE(port.network_down());
  error = 0;
  EXPECT_TRUE(port.send(frame(0x123)));
  EXPECT_FALSE(port.network_down());
}

}  // namespace
}  // namespace volcomp::test
