// SocketCAN and the clock as far as they are the same on every kernel, with CAN and without.

#include <set>

#include "hal/clock.hpp"
#include "hal/linux/socket_can.hpp"
#include "hal/linux/steady_clock.hpp"
#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::OpenResult;
using hal::SocketCan;
static_assert(hal::IsCanPort<SocketCan>::value);
static_assert(hal::IsClock<hal::SteadyClock>::value);

bool is_one_of(OpenResult result, const std::set<OpenResult>& allowed) {
  return allowed.count(result) != 0;
}

TEST(SocketCan, MissingInterfaceIsRefusedByName) {
  SocketCan port;
  const hal::OpenStatus status = port.open("nosuchcan9");
  EXPECT_TRUE(
      is_one_of(status.result, {OpenResult::no_such_interface, OpenResult::no_can_in_kernel}));
  EXPECT_NE(status.error_number, 0);
  EXPECT_EQ(port.descriptor(), -1);
}

TEST(SocketCan, NameLongerThanTheKernelAllowsIsNoInterface) {
  SocketCan port;
  EXPECT_TRUE(is_one_of(port.open("sixteen-letters!").result,
                        {OpenResult::no_such_interface, OpenResult::no_can_in_kernel}));
}

TEST(SocketCan, LoopbackNetworkIsNoCanInterface) {
  SocketCan port;
  EXPECT_TRUE(is_one_of(port.open("lo").result,
                        {OpenResult::not_a_can_interface, OpenResult::interface_down,
                         OpenResult::no_such_interface, OpenResult::no_can_in_kernel}));
  EXPECT_EQ(port.descriptor(), -1);
}

TEST(SocketCan, ClosedPortNeitherSendsNorReceives) {
  SocketCan port;
  hal::CanFrame untouched = frame(0x123, {1, 2});
  EXPECT_FALSE(port.send(untouched));
  EXPECT_FALSE(port.receive(untouched));
  EXPECT_EQ(untouched, frame(0x123, {1, 2}));
  EXPECT_FALSE(port.wait(0));
  EXPECT_FALSE(port.network_down());
}

TEST(OpenStatus, EveryReasonHasItsOwnSentence) {
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(OpenResult::in_use); ++i)
    sentences.insert(hal::sentence(static_cast<OpenResult>(i)));
  EXPECT_EQ(sentences.size(), static_cast<std::size_t>(OpenResult::in_use) + 1);
}

TEST(OpenStatus, WhatTheSystemSaidIsPassedOn) {
  EXPECT_EQ(hal::sentence({OpenResult::failed, EACCES}),
            "the operating system refused: Permission denied");
  EXPECT_EQ(hal::sentence({OpenResult::failed, EROFS}),
            "the operating system refused: Read-only file system");
  EXPECT_EQ(hal::sentence({OpenResult::interface_down, ENETDOWN}), "interface is down");
}

TEST(SteadyClock, NeverGoesBack) {
  const hal::SteadyClock clock;
  std::uint64_t last = clock.now_us();
  for (int i = 0; i < 10'000; ++i) {
    const std::uint64_t now = clock.now_us();
    ASSERT_GE(now, last);
    last = now;
  }
}

}  // namespace
}  // namespace volcomp::test
