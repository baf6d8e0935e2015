#pragma once
// Another program, started here and ended with its owner, however that ends.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace volcomp::sim {

// Where the shell would find this program; empty: nowhere.
[[nodiscard]] std::filesystem::path find_program(const std::string& name);

class ChildProcess {
 public:
  // Runs in `folder`, reads nothing, writes its output to the file `output`. Signals from the
  // terminal do not reach it. Throws UserError when the system refuses.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::filesystem::path& output);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  [[nodiscard]] bool running();
  // False when it still runs after that time.
  [[nodiscard]] bool await_end(int timeout_ms);
  // Once it does not run any more: "ended with exit code 99", "was ended by signal 9 (Killed)".
  [[nodiscard]] std::string how_it_ended() const;
  [[nodiscard]] bool ended_well() const;
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  pid_t id_ = -1;
  std::optional<int> status_;  // of waitpid
};

}  // namespace volcomp::sim
