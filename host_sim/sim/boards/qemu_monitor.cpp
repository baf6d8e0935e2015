#include "host_sim/sim/boards/qemu_monitor.hpp"

#include <chrono>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{30};
constexpr std::uint32_t kLook_us = 100'000;

}  // namespace

QemuMonitor::QemuMonitor(const std::string& socket) : socket_(socket) {
  if (!next_message().contains("QMP")) fail("no QEMU listens there");
  static_cast<void>(ask("qmp_capabilities"));
}

std::uint64_t QemuMonitor::instructions() {
  const nlohmann::json answer = ask("query-replay");
  if (!answer.contains("icount")) fail("this QEMU does not tell how many instructions it executed");
  return answer.at("icount").get<std::uint64_t>();
}

// QEMU also sends events in between.
nlohmann::json QemuMonitor::ask(const char* command) {
  const std::string text = nlohmann::json{{"execute", command}}.dump() + "\n";
  if (socket_.write(text) != text.size()) fail("takes no more commands");
  for (;;) {
    nlohmann::json message = next_message();
    if (message.contains("return")) return message["return"];
    if (message.contains("error")) fail("refuses a command");
  }
}

nlohmann::json QemuMonitor::next_message() {
  const Clock::time_point until = Clock::now() + kPatience;
  std::size_t end = incoming_.find('\n');
  for (; end == std::string::npos; end = incoming_.find('\n')) {
    if (Clock::now() > until) fail("does not answer");
    socket_.wait(kLook_us);
    incoming_ += socket_.read();
  }
  const std::string line = incoming_.substr(0, end);
  incoming_.erase(0, end + 1);
  nlohmann::json message = nlohmann::json::parse(line, nullptr, false);
  if (!message.is_object()) fail("does not answer as QEMU does");
  return message;
}

void QemuMonitor::fail(const char* what) const {
  throw host::UserError(socket_.path() + ": " + what);
}

}  // namespace volcomp::sim
