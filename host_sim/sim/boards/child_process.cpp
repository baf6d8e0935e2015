#include "host_sim/sim/boards/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr int kCouldNotStart = 127;  // exit code of a shell

// What the child needs, made before the fork: after it nothing may be allocated.
struct Plan {
  std::vector<char*> arguments;
  const char* folder;
  const char* output;
  pid_t parent;
};

// Only functions that are safe between fork and exec (POSIX.1, signal-safety).
[[noreturn]] void become(const Plan& plan) {
  // Dies with us, whatever we die of; that may already have happened.
  const bool orphan = ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::getppid() != plan.parent;
  constexpr mode_t kOwnerOnly = 0600;
  const int nothing = ::open("/dev/null", O_RDONLY);
  const int output = ::open(plan.output, O_WRONLY | O_CREAT | O_TRUNC, kOwnerOnly);
  const bool ready = !orphan && nothing >= 0 && output >= 0 && ::setpgid(0, 0) == 0 &&
                     ::chdir(plan.folder) == 0 && ::dup2(nothing, STDIN_FILENO) >= 0 &&
                     ::dup2(output, STDOUT_FILENO) >= 0 && ::dup2(output, STDERR_FILENO) >= 0;
  static_cast<void>(std::signal(SIGPIPE, SIG_DFL));
  if (ready) ::execv(plan.arguments[0], plan.arguments.data());
  ::_exit(kCouldNotStart);
}

pid_t start(std::vector<std::string> command, const std::filesystem::path& folder,
            const std::filesystem::path& output) {
  Plan plan{{}, folder.c_str(), output.c_str(), ::getpid()};
  for (std::string& word : command)
    plan.arguments.push_back(word.data());
  plan.arguments.push_back(nullptr);
  const pid_t id = ::fork();
  if (id == 0) become(plan);
  if (id < 0)
    throw host::UserError(fmt::format("{} cannot be started: {}", command.front(),
                                      std::generic_category().message(errno)));
  return id;
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::filesystem::path candidate = std::filesystem::path(folder) / name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::filesystem::path& folder, const std::filesystem::path& output)
    : id_(start(command, folder, output)) {}

ChildProcess::~ChildProcess() {
  if (!running()) return;
  static_cast<void>(::kill(id_, SIGKILL));
  int ignored = 0;
  while (::waitpid(id_, &ignored, 0) < 0 && errno == EINTR) {
  }
}

bool ChildProcess::running() {
  if (status_) return false;
  int status = 0;
  if (::waitpid(id_, &status, WNOHANG) == id_) status_ = status;
  return !status_;
}

bool ChildProcess::await_end(int timeout_ms) {
  constexpr int kPollInterval_ms = 10;
  for (int waited_ms = 0; running(); waited_ms += kPollInterval_ms) {
    if (waited_ms >= timeout_ms) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(kPollInterval_ms));
  }
  return true;
}

std::string ChildProcess::how_it_ended() const {
  if (!status_) return "still runs";
  if (WIFSIGNALED(*status_)) {
    const int signal = WTERMSIG(*status_);
    return fmt::format("was ended by signal {} ({})", signal, ::strsignal(signal));
  }
  return fmt::format("ended with exit code {}", WEXITSTATUS(*status_));
}

bool ChildProcess::ended_well() const {
  return status_ && WIFEXITED(*status_) && WEXITSTATUS(*status_) == 0;
}

}  // namespace volcomp::sim
