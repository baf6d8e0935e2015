#include "host_sim/sim/live/live_connection.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace volcomp::sim {
namespace {

// A deadline of a call that waits would not be the deadline of the connection.
void set_non_blocking(int fd) {
  const int flags = ::fcntl(fd, F_GETFL);
  if (flags >= 0) static_cast<void>(::fcntl(fd, F_SETFL, flags | O_NONBLOCK));
}

bool try_again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

LiveConnection::LiveConnection(int fd, int stop, const LiveLimits& limits)
    : fd_(fd), stop_(stop), limits_(limits), request_end_(Clock::now() + limits.request) {
  set_non_blocking(fd);
}

LiveConnection::~LiveConnection() {
  static_cast<void>(::shutdown(fd_, SHUT_RDWR));
  static_cast<void>(::close(fd_));
}

bool LiveConnection::await(short events, Clock::time_point deadline) const {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    std::array<pollfd, 2> wait{pollfd{fd_, events, 0}, pollfd{stop_, POLLIN, 0}};
    const int ready = ::poll(wait.data(), wait.size(), static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return false;
    if (ready <= 0) continue;
    return wait[1].revents == 0;
  }
}

bool LiveConnection::is_readable() const { return next_ < filled_ || await(POLLIN, request_end_); }

bool LiveConnection::is_writable() const {
  return await(POLLOUT,
               answer_end_ == Clock::time_point{} ? Clock::now() + limits_.answer : answer_end_);
}

ssize_t LiveConnection::fill() {
  for (;;) {
    if (!await(POLLIN, request_end_)) return -1;
    const ssize_t count = ::recv(fd_, buffer_.data(), buffer_.size(), 0);
    if (count < 0 && try_again()) continue;
    if (count <= 0) return count;
    next_ = 0;
    filled_ = static_cast<std::size_t>(count);
    received_ += filled_;
    return received_ > limits_.request_bytes ? -1 : count;
  }
}

ssize_t LiveConnection::read(char* bytes, std::size_t size) {
  if (next_ == filled_) {
    const ssize_t count = fill();
    if (count <= 0) return count;
  }
  const std::size_t count = std::min(size, filled_ - next_);
  std::copy_n(buffer_.data() + next_, count, bytes);
  next_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t LiveConnection::write(const char* bytes, std::size_t size) {
  if (answer_end_ == Clock::time_point{}) answer_end_ = Clock::now() + limits_.answer;
  for (;;) {
    if (!await(POLLOUT, answer_end_)) return -1;
    const ssize_t count = ::send(fd_, bytes, size, MSG_NOSIGNAL);
    if (count >= 0 || !try_again()) return count;
  }
}

// The library does not use addresses, and there is only one.
void LiveConnection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

void LiveConnection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace volcomp::sim
