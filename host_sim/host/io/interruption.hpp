#pragma once
// Signals that ask the program to end, noticed by whoever looks: so that what was started can be
// ended, and what was made be removed.

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

// While one lives, its file is removed when a signal ends the program at once: nobody looks while
// the program waits for a slow reader of its output. For up to 64 files, of more the first.
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
