#include "hal/linux/socket_can.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace volcomp::hal {
namespace {

// A quarter of a second of a saturated 1 Mbit/s bus: the kernel doubles the value and charges every
// frame with some 800 bytes. Its own limit (net.core.rmem_max) may cut it; the port works then too.
constexpr std::uint32_t kReceiveBufferBytes = 1024 * 1024;
constexpr std::uint32_t kSendBufferBytes = 256 * 1024;

// What tells the state of the controller. Others, with berr-reporting one for every error on the
// bus, would only wake the process.
constexpr std::uint32_t kWantedReports =
    CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_TX_TIMEOUT;

OpenStatus failure(OpenResult result) { return {result, errno}; }

bool set_option(int descriptor, int level, int name, std::uint32_t value) {
  return ::setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

OpenStatus open_socket(int& descriptor) {
  descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor >= 0) return {};
  const bool unknown = errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT;
  return failure(unknown ? OpenResult::no_can_in_kernel : OpenResult::failed);
}

OpenStatus find_interface(int descriptor, const char* name, int& index) {
  const std::size_t length = ::strnlen(name, IFNAMSIZ);
  if (length == IFNAMSIZ) return {OpenResult::no_such_interface, ENAMETOOLONG};
  ifreq request{};
  std::memcpy(request.ifr_name, name, length);
  if (::ioctl(descriptor, SIOCGIFINDEX, &request) != 0)
    return failure(OpenResult::no_such_interface);
  index = request.ifr_ifindex;
  // Requested after the index, because the answers share one union.
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0)
    return failure(OpenResult::no_such_interface);
  const bool up = (static_cast<unsigned>(request.ifr_flags) & unsigned{IFF_UP}) != 0;
  return up ? OpenStatus{} : OpenStatus{OpenResult::interface_down, ENETDOWN};
}

OpenStatus bind_to(int descriptor, int index) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return {};
  // The kernel's answer for an interface that exists and is no CAN interface.
  return failure(errno == ENODEV ? OpenResult::not_a_can_interface : OpenResult::failed);
}

// can_dlc and not its newer name len, which kernel headers before 5.11 do not know.
CanFrame from_kernel(const can_frame& raw) {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
  frame.size = std::min(raw.can_dlc, std::uint8_t{CAN_MAX_DLEN});
  std::copy_n(std::begin(raw.data), frame.size, frame.data.begin());
  return frame;
}

can_frame to_kernel(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id;
  raw.can_dlc = frame.size;
  std::copy_n(frame.data.begin(), frame.size, std::begin(raw.data));
  return raw;
}

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

OpenStatus SocketCan::open(const char* interface) {
  close();
  const OpenStatus status = attach(interface);
  if (!status.ok()) close();
  return status;
}

OpenStatus SocketCan::attach(const char* interface) {
  if (const OpenStatus s = open_socket(descriptor_); !s.ok()) return s;
  int index = 0;
  if (const OpenStatus s = find_interface(descriptor_, interface, index); !s.ok()) return s;
  if (!set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kWantedReports))
    return failure(OpenResult::failed);
  // Beyond rmem_max only a process with CAP_NET_ADMIN gets what it asks for.
  if (!set_option(descriptor_, SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBufferBytes))
    static_cast<void>(set_option(descriptor_, SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes));
  static_cast<void>(set_option(descriptor_, SOL_SOCKET, SO_RXQ_OVFL, 1));
  static_cast<void>(set_option(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, 1));
  static_cast<void>(set_option(descriptor_, SOL_SOCKET, SO_SNDBUF, kSendBufferBytes));
  return bind_to(descriptor_, index);
}

void SocketCan::close() {
  if (descriptor_ >= 0) static_cast<void>(::close(descriptor_));
  descriptor_ = -1;
  network_down_ = false;
  skipped_ = {};
  dropped_ = losses_taken_ = errors_ = 0;
  own_ = false;
  bus_state_ = CanBusState::active;
}

bool SocketCan::send(const CanFrame& frame) { return give(to_kernel(frame)); }

bool SocketCan::send_remote(std::uint16_t id, std::uint8_t size) {
  can_frame raw = to_kernel({id, size, {}});
  raw.can_id |= CAN_RTR_FLAG;
  return give(raw);
}

bool SocketCan::give(const can_frame& raw) {
  if (::send(descriptor_, &raw, sizeof raw, 0) != ssize_t{sizeof raw}) {
    note_failure();
    return false;
  }
  network_down_ = false;
  return true;
}

bool SocketCan::receive(CanFrame& frame) {
  for (int i = 0; i < kMaxSkippedAtOnce; ++i) {
    can_frame raw{};
    if (!take(raw)) {
      note_failure();
      return false;
    }
    network_down_ = false;
    if (skip(raw)) continue;
    frame = from_kernel(raw);
    return true;
  }
  return false;
}

// With a frame come its time (SO_TIMESTAMPNS) and, once it is not 0, the counter of the socket
// (SO_RXQ_OVFL): socket(7).
bool SocketCan::take(can_frame& raw) {
  iovec room{&raw, sizeof raw};
  alignas(cmsghdr)
      std::array<char, CMSG_SPACE(sizeof(std::uint32_t)) + CMSG_SPACE(sizeof(timespec))>
          beside{};
  msghdr message{};
  message.msg_iov = &room;
  message.msg_iovlen = 1;
  message.msg_control = beside.data();
  message.msg_controllen = beside.size();
  if (::recvmsg(descriptor_, &message, 0) != ssize_t{sizeof raw}) return false;
  own_ = (static_cast<unsigned>(message.msg_flags) & unsigned{MSG_CONFIRM}) != 0;
  taken_in_ns_ = 0;
  for (cmsghdr* told = CMSG_FIRSTHDR(&message); told != nullptr;
       told = CMSG_NXTHDR(&message, told)) {
    if (told->cmsg_level != SOL_SOCKET) continue;
    if (told->cmsg_type == SO_RXQ_OVFL) std::memcpy(&dropped_, CMSG_DATA(told), sizeof dropped_);
    if (told->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec at{};
    std::memcpy(&at, CMSG_DATA(told), sizeof at);
    taken_in_ns_ = nanoseconds(at);
  }
  return true;
}

// Only differences of this clock are used: it may be set at any time.
std::uint32_t SocketCan::age_us() const {
  timespec now{};
  if (taken_in_ns_ == 0 || ::clock_gettime(CLOCK_REALTIME, &now) != 0) return 0;
  const std::int64_t us = (nanoseconds(now) - taken_in_ns_) / 1000;
  return static_cast<std::uint32_t>(
      std::max<std::int64_t>(0, std::min<std::int64_t>(us, kMostAge_us)));
}

bool SocketCan::hear_only(Span<const std::uint16_t> ids) const {
  if (ids.size() > kMostFilters) return false;
  std::array<can_filter, kMostFilters> filters{};
  for (std::size_t i = 0; i < ids.size(); ++i)
    filters[i] = {ids[i], CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
  const auto size = static_cast<socklen_t>(ids.size() * sizeof(can_filter));
  return ::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), size) == 0;
}

// MSG_CONFIRM then marks them: Documentation/networking/can.rst, 4.1.7.
bool SocketCan::hear_own() const {
  return set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1);
}

std::uint32_t SocketCan::take_losses() {
  const std::uint32_t lost = dropped_ - losses_taken_;
  losses_taken_ = dropped_;
  return lost;
}

std::uint32_t SocketCan::take_errors() {
  const std::uint32_t errors = errors_;
  errors_ = 0;
  return errors;
}

bool SocketCan::skip(const can_frame& raw) {
  // An error report uses the identifier for flags of its own, so it is checked first.
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    ++skipped_.error;
    note_error(raw);
    return true;
  }
  if ((raw.can_id & CAN_EFF_FLAG) != 0) {
    ++skipped_.extended;
    return true;
  }
  if ((raw.can_id & CAN_RTR_FLAG) != 0) {
    ++skipped_.remote;
    return true;
  }
  return false;
}

// linux/can/error.h. A report of the controller that names no state (a lost frame) changes none.
void SocketCan::note_error(const can_frame& raw) {
  constexpr std::uint8_t kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  constexpr std::uint8_t kWarning = CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING;
  const bool good = (raw.can_id & CAN_ERR_RESTARTED) != 0 ||
                    ((raw.can_id & CAN_ERR_CRTL) != 0 && raw.data[1] == CAN_ERR_CRTL_ACTIVE);
  errors_ += good ? 0 : 1;
  if ((raw.can_id & CAN_ERR_BUSOFF) != 0) {
    bus_state_ = CanBusState::off;
  } else if ((raw.can_id & CAN_ERR_RESTARTED) != 0) {
    bus_state_ = CanBusState::active;
  } else if ((raw.can_id & CAN_ERR_CRTL) != 0) {
    const std::uint8_t controller = raw.data[1];
    if ((controller & CAN_ERR_CRTL_ACTIVE) != 0) bus_state_ = CanBusState::active;
    if ((controller & kWarning) != 0) bus_state_ = CanBusState::warning;
    if ((controller & kPassive) != 0) bus_state_ = CanBusState::passive;
  }
}

void SocketCan::note_failure() {
  if (errno == ENETDOWN || errno == ENODEV || errno == ENXIO) network_down_ = true;
}

bool SocketCan::wait(std::uint32_t timeout_us) const {
  pollfd waiting{};
  waiting.fd = descriptor_;
  waiting.events = POLLIN;
  timespec timeout{};
  timeout.tv_sec = timeout_us / 1'000'000U;
  timeout.tv_nsec = static_cast<long>(timeout_us % 1'000'000U) * 1'000;
  // An error counts as something to receive: receive() then reports the network down.
  return ::ppoll(&waiting, 1, &timeout, nullptr) > 0;
}

}  // namespace volcomp::hal
