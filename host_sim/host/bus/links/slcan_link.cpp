#include "host_sim/host/bus/links/slcan_link.hpp"

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr std::uint64_t kPatience_us = 5'000'000;
constexpr std::uint32_t kLook_us = 10'000;

}  // namespace

SlcanLink::SlcanLink(const std::string& device) : device_(device) { open_channel(); }

SlcanLink::~SlcanLink() {
  try {
    outgoing_ += "C\r";
    flush();
  } catch (const UserError&) {
    return;  // the adapter is gone
  }
}

// An earlier user of the adapter may have left half a line, an open channel and unread answers.
// Every adapter answers V, and what follows that answer belongs to this link.
void SlcanLink::open_channel() {
  outgoing_ = "\r\r\rC\rV\r";
  await_version();
  command("S8\r", "refuses 1 Mbit/s");
  command("O\r", "does not open its channel");
}

void SlcanLink::await_version() {
  const auto is_version = [](Span<const char> line) { return !line.empty() && line[0] == 'V'; };
  const std::uint64_t until_us = now_us() + kPatience_us;
  while (await_event(until_us) != Event::line || !is_version(line_.line())) {
  }
}

void SlcanLink::command(const char* text, const char* refusal) {
  outgoing_ += text;
  if (await_event(now_us() + kPatience_us) == Event::refused) fail(refusal);
}

// --- frames

bool SlcanLink::send(const hal::CanFrame& frame) {
  if (unanswered_ == kMostUnanswered) return false;
  const hal::SlcanText text = hal::slcan_frame(frame);
  outgoing_.append(text.data(), text.size());
  ++unanswered_;
  flush();
  return true;
}

bool SlcanLink::receive(hal::CanFrame& frame) {
  for (Event event = next_event(); event != Event::nothing; event = next_event())
    take(event);
  if (received_.empty()) return false;
  frame = received_.front();
  received_.pop_front();
  return true;
}

void SlcanLink::wait(std::uint32_t timeout_us) {
  flush();
  if (received_.empty() && incoming_.empty()) device_.wait(timeout_us);
  for (Event event = next_event(); event != Event::nothing; event = next_event())
    take(event);
}

// A frame, the answer to one, or something CANopen has no use for.
void SlcanLink::take(Event event) {
  if (event == Event::refused) fail("the adapter refuses a frame: the bus does not take any");
  if (event != Event::line) return;
  const Span<const char> line = line_.line();
  hal::CanFrame frame;
  if (line.empty() || line[0] == 'z') {
    answered();
  } else if (hal::parse_slcan_frame(line, frame)) {
    received_.push_back(frame);
  }
}

void SlcanLink::answered() {
  if (unanswered_ > 0) --unanswered_;
}

// --- bytes

void SlcanLink::flush() { outgoing_.erase(0, device_.write(outgoing_)); }

hal::SlcanLine::Event SlcanLink::next_event() {
  incoming_ += device_.read();
  for (std::size_t i = 0; i < incoming_.size(); ++i) {
    const Event event = line_.take(incoming_[i]);
    if (event == Event::nothing) continue;
    incoming_.erase(0, i + 1);
    return event;
  }
  incoming_.clear();
  return Event::nothing;
}

hal::SlcanLine::Event SlcanLink::await_event(std::uint64_t until_us) {
  while (now_us() < until_us) {
    flush();
    if (const Event event = next_event(); event != Event::nothing) return event;
    device_.wait(kLook_us);
  }
  fail("does not answer as an SLCAN adapter does");
}

void SlcanLink::fail(const char* what) const { throw UserError(device_.path() + ": " + what); }

}  // namespace volcomp::host
