#pragma once
// One connection of a browser with deadlines for the whole request and the whole answer. The HTTP
// library restarts its time-out with every byte, so that a client that drips bytes would hold a
// thread, and with it the end of a run, as long as it likes.

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string>

#include <httplib.h>

#include "host_sim/sim/live/live_server.hpp"

namespace volcomp::sim {

class LiveConnection : public httplib::Stream {
 public:
  // Owns the socket `fd` and closes it. Every wait ends when the file descriptor `stop` becomes
  // readable.
  LiveConnection(int fd, int stop, const LiveLimits& limits);
  LiveConnection(const LiveConnection&) = delete;
  LiveConnection& operator=(const LiveConnection&) = delete;
  ~LiveConnection() override;

  // read and write: bytes moved, 0 at the end of the stream, −1 after a deadline, a stop, an error
  // or more bytes than a request may have.
  [[nodiscard]] bool is_readable() const override;
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return fd_; }

 private:
  using Clock = std::chrono::steady_clock;

  // Waits for `events` of the socket; false at the deadline or when it is to stop.
  [[nodiscard]] bool await(short events, Clock::time_point deadline) const;
  [[nodiscard]] ssize_t fill();

  int fd_;
  int stop_;
  LiveLimits limits_;
  Clock::time_point request_end_;
  Clock::time_point answer_end_{};  // set when the answer begins
  std::size_t received_ = 0;
  std::array<char, 4096> buffer_{};
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
};

}  // namespace volcomp::sim
