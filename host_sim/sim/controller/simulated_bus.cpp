#include "host_sim/sim/controller/simulated_bus.hpp"

#include <algorithm>
#include <numeric>

namespace volcomp::sim {
namespace {

// Every port is served at least so often, with or without frames; on a bus that has been quiet for
// a while as often as timers of CANopen count (CiA 301: milliseconds).
constexpr std::uint64_t kSlice_ns = 200'000;
constexpr std::uint64_t kQuietSlice_ns = 1'000'000;
constexpr std::uint64_t kQuietAfter_ns = 2'000'000;

}  // namespace

SimulatedBus::Port& SimulatedBus::attach_served(std::string name, Serve serve,
                                                std::size_t mailboxes) {
  Port& port = bus_.attach(std::move(name), mailboxes);
  participants_.push_back({&port, std::move(serve)});
  return port;
}

// Nothing has arrived, and it has nothing to do yet.
bool SimulatedBus::rests(const Participant& p, std::uint64_t now_us) const {
  return now_us < p.rests_until_us && !called_ && p.port->waiting() == 0;
}

void SimulatedBus::serve(Participant& p, std::uint64_t now_us) {
  if (p.serve && p.port->connected()) p.rests_until_us = p.serve(*p.port, now_us);
}

void SimulatedBus::serve_all() {
  const std::uint64_t now = now_us();
  for (Participant& p : participants_) {
    if (!rests(p, now)) serve(p, now);
  }
}

// Those that a frame has reached, though it may not concern them, or that have a mailbox free
// again.
void SimulatedBus::serve_concerned() {
  const std::uint64_t now = now_us();
  for (Participant& p : participants_) {
    const std::uint64_t frames = p.port->counters().sent + p.port->counters().received;
    if (p.port->waiting() == 0 && frames == p.frames) continue;
    p.frames = frames;
    if (!rests(p, now)) serve(p, now);
  }
}

void SimulatedBus::first_round() {
  called_ = true;
  serve_all();
  called_ = always_;
}

void SimulatedBus::first_round(const Port& called) {
  const std::uint64_t now = now_us();
  for (Participant& p : participants_) {
    called_ = always_ || p.port == &called;
    if (!rests(p, now)) serve(p, now);
  }
  called_ = always_;
}

void SimulatedBus::run_until(std::uint64_t time_ns) {
  if (bus_.now_ns() >= time_ns) return;
  first_round();
  go_on_until(time_ns);
}

void SimulatedBus::run_until(std::uint64_t time_ns, const Port& called) {
  if (bus_.now_ns() >= time_ns) return;
  first_round(called);
  go_on_until(time_ns);
}

void SimulatedBus::go_on_until(std::uint64_t time_ns) {
  // Before this time no participant has anything to do, unless a frame arrives; 0: to be asked.
  std::uint64_t all_rest_until_us = 0;
  const auto least = [](std::uint64_t until_us, const Participant& p) {
    return std::min(until_us, p.rests_until_us);
  };
  while (true) {
    const bool quiet = bus_.now_ns() - last_frame_ns_ >= kQuietAfter_ns;
    const std::uint64_t slice = quiet ? kQuietSlice_ns : kSlice_ns;
    const std::uint64_t slice_end = std::min(time_ns, bus_.now_ns() + slice);
    while (bus_.step(slice_end)) {
      last_frame_ns_ = bus_.now_ns();
      serve_concerned();
      all_rest_until_us = 0;
    }
    if (bus_.now_ns() >= time_ns) return;
    if (all_rest_until_us == 0)
      all_rest_until_us =
          std::accumulate(participants_.begin(), participants_.end(), UINT64_MAX, least);
    if (now_us() < all_rest_until_us && !called_) continue;
    serve_all();
    all_rest_until_us = 0;
  }
}

void SimulatedBus::run_until_quiet() {
  first_round();
  while (bus_.step(bus_.now_ns() + 1)) {
    last_frame_ns_ = bus_.now_ns();
    serve_concerned();
  }
}

}  // namespace volcomp::sim
