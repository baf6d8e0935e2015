#include "host_sim/host/io/interruption.hpp"

#include <array>

namespace volcomp::host {
namespace {

struct Noted {
  int signal;
  void (*before)(int);
};

std::array<Noted, 3> noted_signals{{{SIGINT, SIG_DFL}, {SIGTERM, SIG_DFL}, {SIGHUP, SIG_DFL}}};
int living = 0;
volatile std::sig_atomic_t noted = 0;

// The second one ends the program at once: whoever should look may be stuck.
void note(int signal) {
  noted = signal;
  static_cast<void>(std::signal(signal, SIG_DFL));
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
    static_cast<void>(std::signal(each.signal, each.before));
}

// Members, so that nobody asks without having asked for it.
// NOLINTBEGIN(readability-convert-member-functions-to-static)
bool Interruption::asked() const { return noted != 0; }

void Interruption::check() const {
  if (noted != 0) throw Interrupted(noted);
}
// NOLINTEND(readability-convert-member-functions-to-static)

}  // namespace volcomp::host
