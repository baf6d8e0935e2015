#pragma once
// Signals that ask the program to end, noticed by whoever looks: so that what was started can be
// ended, and what was made be removed.

#include <csignal>
#include <stdexcept>

namespace volcomp::host {

// Ends the program as the signal would have done (main).
struct Interrupted : std::runtime_error {
  explicit Interrupted(int number) : std::runtime_error("interrupted"), signal(number) {}
  int signal;
};

// While one lives, SIGINT, SIGTERM and SIGHUP are only noted, each once: the second of a kind ends
// the program as ever. SIGHUP stays ignored where it was (nohup). One inside another is fine: both
// see them.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  // Whether there was such a signal.
  [[nodiscard]] bool asked() const;
  // Throws Interrupted when there was.
  void check() const;
};

}  // namespace volcomp::host
