#include "host_sim/cli/run_view.hpp"

#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "host_sim/host/report/page/report.hpp"

namespace volcomp::cli {
namespace {

constexpr std::chrono::milliseconds kMoment{50};
constexpr std::uint32_t kUnseen = 4096;  // periods between two that a feed without a page takes

void say(std::FILE* words, const std::string& line) {
  fmt::print(words, "{}\n", line);
  static_cast<void>(std::fflush(words));  // a reader of a pipe waits for it
}

// Ends a run that is interrupted.
class InterruptedObserver final : public sim::MachineObserver {
 public:
  InterruptedObserver(const host::Interruption& interruption,
                      std::unique_ptr<sim::MachineObserver> behind)
      : interruption_(interruption), behind_(std::move(behind)) {}

  void cycle(const sim::MachineSnapshot& snapshot) override {
    interruption_.check();
    behind_->cycle(snapshot);
  }

 private:
  const host::Interruption& interruption_;
  std::unique_ptr<sim::MachineObserver> behind_;
};

}  // namespace

RunView::RunView(const LiveChoice& choice, const std::string& command, const std::string& transport,
                 std::FILE* words)
    : choice_(choice), words_(words), feed_(command, transport, choice.port ? 1 : kUnseen) {
  if (!choice.port) return;
  server_ = std::make_unique<sim::LiveServer>(*choice.port, [this] {
    return feed_.state().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  });
  say(words_, "live: " + server_->address());
}

std::unique_ptr<sim::MachineObserver> RunView::enter() {
  return std::make_unique<InterruptedObserver>(interruption_, feed_.enter());
}

void RunView::progress(double done, const std::string& what) {
  interruption_.check();
  feed_.progress(done, what);
}

void RunView::ended(const nlohmann::json& document) {
  if (server_ && choice_.stay)
    server_->offer_report(host::report_html(document), host::report_text(document));
  feed_.ended(document, choice_.stay);
  if (!server_) return;
  if (choice_.stay) {
    stay();
  } else {
    await_readers();
  }
}

void RunView::failed(const std::string& why) {
  feed_.failed(why);
  if (server_) await_readers();
}

// A page polls four times a second; the second answer from now on is certain to contain the end.
void RunView::await_readers() const {
  constexpr int kPatience = 60;    // moments
  constexpr int kOtherPages = 10;  // moments for pages that poll less often
  constexpr std::uint64_t kSurely = 2;
  const std::uint64_t before = server_->told();
  for (int i = 0; i < kPatience && server_->watched() && !interruption_.asked(); ++i) {
    std::this_thread::sleep_for(kMoment);
    if (server_->told() < before + kSurely) continue;
    std::this_thread::sleep_for(kOtherPages * kMoment);
    return;
  }
}

void RunView::stay() const {
  say(words_, fmt::format("The run has ended. {} stays until Ctrl+C.", server_->address()));
  while (!interruption_.asked())
    std::this_thread::sleep_for(kMoment);
}

}  // namespace volcomp::cli
