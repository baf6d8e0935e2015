#include "hal/linux/can_interface.hpp"

#include <linux/can/netlink.h>
#include <linux/if.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace volcomp::hal {
namespace {

using Bytes = Span<const std::uint8_t>;

constexpr auto kTypeMask = static_cast<std::uint16_t>(NLA_TYPE_MASK);

constexpr std::size_t aligned(std::size_t size) { return (size + 3U) & ~std::size_t{3}; }

// The value at the begin of the bytes, zero where they are too few.
template <class Value>
Value load(Bytes bytes) {
  Value value{};
  if (bytes.size() >= sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

Bytes from(Bytes bytes, std::size_t begin) {
  if (begin >= bytes.size()) return {};
  return {bytes.data() + begin, bytes.size() - begin};
}

// The attribute of this type, without its head; empty where there is none.
Bytes attribute(Bytes attributes, unsigned type) {
  while (attributes.size() >= sizeof(rtattr)) {
    const auto head = load<rtattr>(attributes);
    if (head.rta_len < sizeof head || head.rta_len > attributes.size()) return {};
    if ((head.rta_type & kTypeMask) == type)
      return {attributes.data() + sizeof head, head.rta_len - sizeof head};
    attributes = from(attributes, aligned(head.rta_len));
  }
  return {};
}

bool says(Bytes text, const char* wanted) {
  return text.size() == std::strlen(wanted) + 1 &&
         std::memcmp(text.data(), wanted, text.size()) == 0;
}

void note_controller(Bytes data, CanInterface& found) {
  found.controller = true;
  found.bit_rate = load<can_bittiming>(attribute(data, IFLA_CAN_BITTIMING)).bitrate;
  found.restart_ms = load<std::uint32_t>(attribute(data, IFLA_CAN_RESTART_MS));
  const auto mode = load<can_ctrlmode>(attribute(data, IFLA_CAN_CTRLMODE));
  found.reports_bus_errors = (mode.flags & unsigned{CAN_CTRLMODE_BERR_REPORTING}) != 0;
}

struct Request {
  nlmsghdr head{};
  ifinfomsg link{};
  rtattr name_head{};
  std::array<char, IFNAMSIZ> name{};
};

bool send_request(int descriptor, const char* interface) {
  Request request;
  const std::size_t length = ::strnlen(interface, IFNAMSIZ);
  if (length == IFNAMSIZ) return false;
  std::memcpy(request.name.data(), interface, length);
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.name_head.rta_type = IFLA_IFNAME;
  request.name_head.rta_len =
      static_cast<unsigned short>(sizeof request.name_head + sizeof request.name);
  return ::send(descriptor, &request, sizeof request, 0) == ssize_t{sizeof request};
}

}  // namespace

CanInterface parse_link(Bytes message) {
  CanInterface found;
  const auto head = load<nlmsghdr>(message);
  const std::size_t begin = aligned(sizeof head);
  if (head.nlmsg_type != RTM_NEWLINK || head.nlmsg_len < begin + sizeof(ifinfomsg) ||
      head.nlmsg_len > message.size())
    return found;
  const Bytes link = from({message.data(), head.nlmsg_len}, begin);
  const Bytes attributes = from(link, aligned(sizeof(ifinfomsg)));
  found.known = true;
  found.echoes = (load<ifinfomsg>(link).ifi_flags & unsigned{IFF_ECHO}) != 0;
  found.queue = load<std::uint32_t>(attribute(attributes, IFLA_TXQLEN));
  const Bytes info = attribute(attributes, IFLA_LINKINFO);
  if (says(attribute(info, IFLA_INFO_KIND), "can"))
    note_controller(attribute(info, IFLA_INFO_DATA), found);
  return found;
}

CanInterface ask_link(const char* interface) {
  const int descriptor = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (descriptor < 0) return {};
  timeval patience{};
  patience.tv_sec = 1;
  static_cast<void>(::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience));
  // An answer has about 1.5 kB; one that does not fit is not understood.
  std::array<std::uint8_t, 8192> answer{};
  ssize_t size = -1;
  if (send_request(descriptor, interface))
    size = ::recv(descriptor, answer.data(), answer.size(), 0);
  static_cast<void>(::close(descriptor));
  if (size <= 0) return {};
  return parse_link({answer.data(), static_cast<std::size_t>(size)});
}

}  // namespace volcomp::hal
