// The answer of rtnetlink about a CAN interface, made by hand from linux/rtnetlink.h,
// linux/if_link.h and linux/can/netlink.h.

#include "hal/linux/can_interface.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>

#include <cstring>
#include <string>
#include <vector>

#include "tests/hal/support.hpp"
#include "tests/hal/system_calls.hpp"

namespace volcomp::test {
namespace {

using hal::CanInterface;
using Block = std::vector<std::uint8_t>;

// IFF_ECHO of linux/if.h, which does not go together with net/if.h.
constexpr unsigned kEcho = 1U << 18U;

template <class Value>
Block bytes_of(const Value& value) {
  Block bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

Block text(const std::string& value) {
  Block bytes(value.begin(), value.end());
  bytes.push_back(0);
  return bytes;
}

Block operator+(Block first, const Block& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// Length and type in front, filled up to four bytes.
Block attribute(unsigned type, const Block& value) {
  Block bytes = bytes_of(static_cast<std::uint16_t>(4 + value.size())) +
                bytes_of(static_cast<std::uint16_t>(type)) + value;
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return bytes;
}

Block message(std::uint16_t type, unsigned flags, const Block& attributes) {
  ifinfomsg link{};
  link.ifi_flags = flags;
  const Block body = bytes_of(link) + attributes;
  nlmsghdr head{};
  head.nlmsg_type = type;
  head.nlmsg_len = static_cast<std::uint32_t>(sizeof head + body.size());
  return bytes_of(head) + body;
}

Block controller(std::uint32_t bit_rate, std::uint32_t restart_ms, std::uint32_t mode) {
  can_bittiming timing{};
  timing.bitrate = bit_rate;
  const Block data = attribute(IFLA_CAN_BITTIMING, bytes_of(timing)) +
                     attribute(IFLA_CAN_CTRLMODE, bytes_of(can_ctrlmode{0, mode})) +
                     attribute(IFLA_CAN_RESTART_MS, bytes_of(restart_ms));
  return attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, text("can")) +
                                      attribute(NLA_F_NESTED | unsigned{IFLA_INFO_DATA}, data));
}

Block queue(std::uint32_t frames) { return attribute(IFLA_TXQLEN, bytes_of(frames)); }

CanInterface parse(const Block& answer) { return hal::parse_link({answer.data(), answer.size()}); }

TEST(CanInterface, IsReadFromItsAttributes) {
  const CanInterface found =
      parse(message(RTM_NEWLINK, kEcho,
                    attribute(IFLA_IFNAME, text("can0")) + queue(16) +
                        controller(1'000'000, 100, CAN_CTRLMODE_BERR_REPORTING | CAN_CTRLMODE_FD)));
  EXPECT_TRUE(found.known);
  EXPECT_TRUE(found.controller);
  EXPECT_TRUE(found.echoes);
  EXPECT_EQ(found.bit_rate, 1'000'000U);
  EXPECT_EQ(found.queue, 16U);
  EXPECT_EQ(found.restart_ms, 100U);
  EXPECT_TRUE(found.reports_bus_errors);
  const CanInterface other =
      parse(message(RTM_NEWLINK, 0, queue(1000) + controller(0, 0, CAN_CTRLMODE_FD)));
  EXPECT_FALSE(other.echoes);
  EXPECT_EQ(other.bit_rate, 0U);
  EXPECT_EQ(other.queue, 1000U);
  EXPECT_FALSE(other.reports_bus_errors);
}

TEST(CanInterface, OfVcanHasNoController) {
  const CanInterface found = parse(
      message(RTM_NEWLINK, 0,
              queue(1000) + attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, text("vcan")))));
  EXPECT_TRUE(found.known);
  EXPECT_FALSE(found.controller);
}

TEST(CanInterface, AnythingElseIsNotKnown) {
  const Block whole = message(RTM_NEWLINK, kEcho, queue(16) + controller(1'000'000, 0, 0));
  EXPECT_FALSE(parse({}).known);
  EXPECT_FALSE(parse(message(NLMSG_ERROR, 0, {})).known);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(hal::parse_link({whole.data(), size}).known) << size;
}

// Lengths that point beyond the message, or nowhere.
TEST(CanInterface, DamagedAttributesAreLeftOut) {
  Block damaged = message(RTM_NEWLINK, 0, queue(16) + controller(1'000'000, 0, 0));
  const std::size_t first = sizeof(nlmsghdr) + sizeof(ifinfomsg);
  for (const int length : {0, 3, 255}) {
    damaged[first] = static_cast<std::uint8_t>(length);
    const CanInterface found = parse(damaged);
    EXPECT_TRUE(found.known);
    EXPECT_EQ(found.queue, 0U);
    EXPECT_FALSE(found.controller);
  }
}

TEST(CanInterface, IsNotKnownWhereThereIsNoNetlink) {
  SystemCalls calls;
  calls.socket = [](int domain, int, int protocol) {
    EXPECT_EQ(domain, AF_NETLINK);
    EXPECT_EQ(protocol, NETLINK_ROUTE);
    return failing(EAFNOSUPPORT);
  };
  EXPECT_FALSE(hal::ask_link("can0").known);
}

// The kernel of this computer: every one has "lo".
TEST(CanInterface, OfTheLoopbackIsKnownAndNoController) {
  const CanInterface found = hal::ask_link("lo");
  EXPECT_TRUE(found.known);
  EXPECT_FALSE(found.controller);
  EXPECT_FALSE(hal::ask_link("no_such_if").known);
  EXPECT_FALSE(hal::ask_link("a_name_that_is_too_long").known);
}

}  // namespace
}  // namespace volcomp::test
