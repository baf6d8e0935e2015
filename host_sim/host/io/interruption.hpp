#pragma once
// Signals that end the program, noted until the code checks them: so that it can stop what it has
// started and remove what it has made.

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace volcomp::host {

// Ends the program as the signal would have done (main).
struct Interrupted : std::runtime_error {
  explicit Interrupted(int number) : std::runtime_error("interrupted"), signal(number) {}
  int signal;
};

// While one exists, SIGINT, SIGTERM and SIGHUP are only noted, each once: the second of a kind ends
// the program as usual. SIGHUP stays ignored where it was (nohup). They may nest: both see the
// signals.
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

// While one exists, this thread receives SIGINT, SIGTERM and SIGHUP only afterwards, and threads
// that it starts never do; where another thread receives one that ends the program, it waits for
// this one: nothing is left between the creation of a file and its registration.
class SignalsHeld {
 public:
  SignalsHeld();
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;
  ~SignalsHeld();

 private:
  sigset_t before_{};
};

// While one exists, its file or empty folder is removed when a signal ends the program at once: no
// code checks for signals while the program waits for a slow reader of its output. Holds for the
// first 64; a folder in another is registered after it. Create and register under SignalsHeld.
class RemovedBySignal {
 public:
  explicit RemovedBySignal(const std::filesystem::path& path);
  RemovedBySignal(const RemovedBySignal&) = delete;
  RemovedBySignal& operator=(const RemovedBySignal&) = delete;
  ~RemovedBySignal();

 private:
  std::string path_;
  std::size_t slot_;
};

}  // namespace volcomp::host
