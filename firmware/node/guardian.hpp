#pragma once
// Decides whether the watchdog is fed. Only the tick feeds it, so a dead tick triggers it by
// itself; the guardian makes a dead background trigger it too, but only after the corrections have
// ramped to zero:
//
//   trusting ──token too old──► ramping ──at rest, or ramp_us over──► starving
//      ▲                           │
//      └────────token again────────┘
//
// A background that comes back while corrections are being ramped down is trusted again: nothing
// restarts, the corrections stay at zero until tables are activated. Starving is final: the
// watchdog may trigger at any moment, and a restart that is cancelled only sometimes cannot be
// relied on.

#include <cstdint>

#include "comp/core/atomic_word.hpp"

namespace volcomp::node {

struct GuardianSettings {
  std::uint32_t stale_us = 100'000;        // the background is overdue beyond this
  std::uint32_t long_work_us = 5'000'000;  // the same while it does work it has announced as long
  std::uint32_t ramp_us = 5'000'000;       // for the corrections to come to rest, at most
};

class Guardian {
 public:
  enum class State : std::uint8_t { trusting, ramping, starving };

  explicit Guardian(const GuardianSettings& settings) : settings_(settings) {}

  // --- background

  // Once per round, at least every stale_us.
  void alive() {  // only the background writes the token: no read-modify-write needed
    token_.store(token_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  // The work that follows may take up to long_work_us, or is done. Counts as a token.
  void announce_long_work(bool begins) {
    long_work_.store(begins ? 1 : 0, std::memory_order_relaxed);
    alive();
  }

  // --- interrupt

  // Once per tick. `at_rest`: no drive holds a correction any more. `needed`: a drive follows what
  // the tick sends and would stop with it, so the watchdog waits until none does.
  State check(std::uint64_t now_us, bool at_rest, bool needed = false) {
    if (take_token(now_us)) {
      if (state_ == State::ramping) state_ = State::trusting;
      return state_;
    }
    if (state_ == State::trusting && now_us - fresh_us_ > patience_us()) {
      state_ = State::ramping;
      ramping_since_us_ = now_us;
    } else if (state_ == State::ramping && !needed &&
               (at_rest || now_us - ramping_since_us_ > settings_.ramp_us)) {
      state_ = State::starving;
    }
    return state_;
  }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool long_work() const { return long_work_.load(std::memory_order_relaxed) != 0; }

 private:
  [[nodiscard]] std::uint32_t patience_us() const {
    return long_work() ? settings_.long_work_us : settings_.stale_us;
  }
  // The first check counts as a token: the background may not have run yet.
  bool take_token(std::uint64_t now_us) {
    const std::uint32_t token = token_.load(std::memory_order_relaxed);
    if (started_ && token == seen_) return false;
    started_ = true;
    seen_ = token;
    fresh_us_ = now_us;
    return true;
  }

  GuardianSettings settings_;
  AtomicWord<> token_{0};
  AtomicWord<> long_work_{0};
  State state_ = State::trusting;
  std::uint32_t seen_ = 0;
  std::uint64_t fresh_us_ = 0;
  std::uint64_t ramping_since_us_ = 0;
  bool started_ = false;
};

}  // namespace volcomp::node
