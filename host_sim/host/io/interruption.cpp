#include "host_sim/host/io/interruption.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <ctime>

namespace volcomp::host {
namespace {

struct Noted {
  int signal;
  void (*before)(int);
};

std::array<Noted, 3> noted_signals{{{SIGINT, SIG_DFL}, {SIGTERM, SIG_DFL}, {SIGHUP, SIG_DFL}}};
int living = 0;
volatile std::sig_atomic_t noted = 0;

constexpr std::size_t kMostRemoved = 64;
std::array<std::atomic<const char*>, kMostRemoved> removed{};
static_assert(std::atomic<const char*>::is_always_lock_free);

std::atomic<bool> ending{false};
std::atomic<int> holding{0};  // threads between the creation of a file and its registration
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// No thread begins to create a file any more. Not for ever: one may wait for memory that the
// interrupted thread holds. The thread of the handler is none of them.
void await_registrations() {
  constexpr int kMostTurns = 100;
  constexpr timespec kTurn{0, 1'000'000};
  ending = true;
  for (int turn = 0; turn < kMostTurns && holding.load() > 0; ++turn)
    static_cast<void>(::nanosleep(&kTurn, nullptr));
}

// As without a handler, but for the files. Calls what a handler may (POSIX.1-2017, 2.4.3).
void end_program(int signal) {
  await_registrations();
  for (const std::atomic<const char*>& path : removed) {
    if (const char* const name = path.load(); name != nullptr) static_cast<void>(::unlink(name));
  }
  // Folders lose their files first, and an inner one has been registered after the outer one.
  for (std::size_t slot = removed.size(); slot > 0; --slot) {
    const char* const name = removed.at(slot - 1).load();
    if (name != nullptr) static_cast<void>(::rmdir(name));
  }
  static_cast<void>(std::signal(signal, SIG_DFL));
  static_cast<void>(std::raise(signal));
}

// The second signal ends the program at once: the code that checks may be blocked.
void note(int signal) {
  noted = signal;
  static_cast<void>(std::signal(signal, end_program));
}

// Only where the signal would end the program: not under nohup, nor while an Interruption lives.
void end_program_by_signals() {
  for (const Noted& each : noted_signals) {
    struct sigaction now {};
    const bool known = ::sigaction(each.signal, nullptr, &now) == 0;
    if (known && now.sa_handler == SIG_DFL)
      static_cast<void>(std::signal(each.signal, end_program));
  }
}

std::size_t take_slot(const char* path) {
  for (std::size_t slot = 0; slot < removed.size(); ++slot) {
    const char* none = nullptr;
    if (removed.at(slot).compare_exchange_strong(none, path)) return slot;
  }
  return kMostRemoved;
}

}  // namespace

Interruption::Interruption() {
  if (living++ > 0) return;
  noted = 0;
  for (Noted& each : noted_signals) {
    each.before = std::signal(each.signal, note);
    const bool started_by_nohup = each.signal == SIGHUP && each.before == SIG_IGN;
    if (started_by_nohup) static_cast<void>(std::signal(SIGHUP, SIG_IGN));
  }
}

Interruption::~Interruption() {
  if (--living > 0) return;
  for (const Noted& each : noted_signals)
    static_cast<void>(std::signal(each.signal, each.before == SIG_DFL ? end_program : each.before));
}

// Members, so that only the owner of an Interruption can query it.
// NOLINTBEGIN(readability-convert-member-functions-to-static)
bool Interruption::asked() const { return noted != 0; }

void Interruption::check() const {
  if (noted != 0) throw Interrupted(noted);
}
// NOLINTEND(readability-convert-member-functions-to-static)

// Another thread receives what this one holds.
SignalsHeld::SignalsHeld() {
  end_program_by_signals();
  sigset_t held{};
  static_cast<void>(::sigemptyset(&held));
  for (const Noted& each : noted_signals)
    static_cast<void>(::sigaddset(&held, each.signal));
  static_cast<void>(::pthread_sigmask(SIG_BLOCK, &held, &before_));
  ++holding;
  if (!ending) return;
  --holding;
  for (;;)
    static_cast<void>(::pause());
}

SignalsHeld::~SignalsHeld() {
  --holding;
  static_cast<void>(::pthread_sigmask(SIG_SETMASK, &before_, nullptr));
}

RemovedBySignal::RemovedBySignal(const std::filesystem::path& path)
    : path_(std::filesystem::absolute(path).string()), slot_(take_slot(path_.c_str())) {
  end_program_by_signals();
}

RemovedBySignal::~RemovedBySignal() {
  if (slot_ < kMostRemoved) removed.at(slot_) = nullptr;
}

}  // namespace volcomp::host
