#include "host_sim/data/interruption.hpp"

namespace volcomp::sim {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int signal) { noted = signal; }

}  // namespace

Interruption::Interruption()
    : interrupt_before_(std::signal(SIGINT, note)),
      terminate_before_(std::signal(SIGTERM, note)),
      hang_up_before_(std::signal(SIGHUP, note)) {
  noted = 0;
}

Interruption::~Interruption() {
  static_cast<void>(std::signal(SIGINT, interrupt_before_));
  static_cast<void>(std::signal(SIGTERM, terminate_before_));
  static_cast<void>(std::signal(SIGHUP, hang_up_before_));
}

// A member, so that nobody asks without having asked for it.
// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void Interruption::check() const {
  if (noted != 0) throw Interrupted(noted);
}

}  // namespace volcomp::sim
