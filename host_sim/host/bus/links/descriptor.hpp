#pragma once
// A file descriptor that is closed with its owner, and the signal of a broken pipe.

#include <unistd.h>

#include <csignal>
#include <utility>

namespace volcomp::host {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) static_cast<void>(::close(number_));
  }

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool open() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

// While one exists, writing to a pipe without a reader fails (EPIPE) instead of ending the process.
// Made and ended by one thread, in any order.
class BrokenPipeIgnored {
 public:
  BrokenPipeIgnored() {
    if (living_++ == 0) before_ = std::signal(SIGPIPE, SIG_IGN);
  }
  BrokenPipeIgnored(const BrokenPipeIgnored&) = delete;
  BrokenPipeIgnored& operator=(const BrokenPipeIgnored&) = delete;
  ~BrokenPipeIgnored() {
    if (--living_ == 0) static_cast<void>(std::signal(SIGPIPE, before_));
  }

 private:
  inline static int living_ = 0;
  inline static void (*before_)(int) = SIG_DFL;
};

}  // namespace volcomp::host
