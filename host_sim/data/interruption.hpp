#pragma once
// Signals that ask the program to end, noticed by whoever looks: so that what was started can be
// ended, and what was made be removed.

#include <csignal>
#include <stdexcept>

namespace volcomp::sim {

// Ends the program as the signal would have done (main).
struct Interrupted : std::runtime_error {
  explicit Interrupted(int number) : std::runtime_error("interrupted"), signal(number) {}
  int signal;
};

// While one lives, SIGINT, SIGTERM and SIGHUP are only noted. One at a time.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  // Throws Interrupted when there was such a signal.
  void check() const;

 private:
  using Handler = void (*)(int);
  Handler interrupt_before_;
  Handler terminate_before_;
  Handler hang_up_before_;
};

}  // namespace volcomp::sim
