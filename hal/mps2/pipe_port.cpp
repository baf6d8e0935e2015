#include "hal/mps2/pipe_port.hpp"

#include <algorithm>

#include "hal/mps2/semihosting.hpp"

namespace volcomp::hal::mps2 {

bool PipePort::open() {
  to_node_ = semihosting::open(kPipeToNode, semihosting::Mode::read);
  if (to_node_ < 0) return false;
  from_node_ = semihosting::open(kPipeFromNode, semihosting::Mode::write);
  return from_node_ >= 0;
}

void PipePort::begin_turn() {
  PipeBytes bytes{};
  // One record at a time: how many instructions that takes must not depend on how fast they come.
  do {
    if (end() == End::none && !semihosting::read(to_node_, bytes)) finish(End::gone);
  } while (end() == End::none && take(pipe_record(bytes)));
}

// False: the turn is complete, or everything is at an end.
bool PipePort::take(const PipeRecord& record) {
  switch (record.kind) {
    case PipeRecord::Kind::frame:
      if (received_.push(record.frame)) return true;
      finish(End::too_many_frames);
      break;
    case PipeRecord::Kind::end_of_turn:
      now_us_ = record.sender_us;
      break;
    case PipeRecord::Kind::quit:
      finish(End::told_to_quit);
      break;
    case PipeRecord::Kind::malformed:
      finish(End::nonsense);
      break;
  }
  return false;
}

bool PipePort::send(const CanFrame& frame) {
  if (outgoing_bytes_ + 2 * kPipeRecordBytes > outgoing_.size()) return false;
  write_record(pipe_frame(frame));
  return true;
}

void PipePort::end_turn() {
  write_record(pipe_end_of_turn(now_us_));
  const Span<const std::uint8_t> turn{outgoing_.data(), outgoing_bytes_};
  if (end() == End::none && !semihosting::write(from_node_, turn)) finish(End::gone);
  outgoing_bytes_ = 0;
}

void PipePort::finish(End end) { end_.store(end, std::memory_order_relaxed); }

void PipePort::write_record(const PipeBytes& record) {
  std::copy(record.begin(), record.end(), &outgoing_[outgoing_bytes_]);
  outgoing_bytes_ += record.size();
}

}  // namespace volcomp::hal::mps2
