#include "hal/mps2/pipe_port.hpp"

#include <algorithm>

#include "hal/mps2/console.hpp"
#include "hal/mps2/semihosting.hpp"

namespace volcomp::hal::mps2 {
namespace {

constexpr int kToldToEnd = 0;
constexpr int kUnusableInput = 2;

void give_up(const char* sentence) {
  console::put(sentence);
  semihosting::exit(kUnusableInput);
}

}  // namespace

bool PipePort::open() {
  to_node_ = semihosting::open(kPipeToNode, semihosting::Mode::read);
  if (to_node_ < 0) return false;
  from_node_ = semihosting::open(kPipeFromNode, semihosting::Mode::write);
  return from_node_ >= 0;
}

void PipePort::begin_turn() {
  for (;;) {
    PipeBytes bytes{};
    // One record at a time: how many instructions that takes must not depend on how fast they come.
    if (!semihosting::read(to_node_, bytes)) give_up("The other end of the frame pipe is gone.\n");
    const PipeRecord record = pipe_record(bytes);
    switch (record.kind) {
      case PipeRecord::Kind::frame:
        if (!received_.push(record.frame)) give_up("More frames in one turn than fit.\n");
        break;
      case PipeRecord::Kind::end_of_turn:
        now_us_ = record.sender_us;
        return;
      case PipeRecord::Kind::quit:
        semihosting::exit(kToldToEnd);
        break;
      case PipeRecord::Kind::malformed:
        give_up("What comes from the frame pipe is not a record of it.\n");
        break;
    }
  }
}

bool PipePort::send(const CanFrame& frame) {
  if (outgoing_bytes_ + 2 * kPipeRecordBytes > outgoing_.size()) return false;
  write_record(pipe_frame(frame));
  return true;
}

void PipePort::end_turn() {
  write_record(pipe_end_of_turn(now_us_));
  const Span<const std::uint8_t> turn{outgoing_.data(), outgoing_bytes_};
  if (!semihosting::write(from_node_, turn)) give_up("The other end of the frame pipe is gone.\n");
  outgoing_bytes_ = 0;
}

void PipePort::write_record(const PipeBytes& record) {
  std::copy(record.begin(), record.end(), &outgoing_[outgoing_bytes_]);
  outgoing_bytes_ += record.size();
}

}  // namespace volcomp::hal::mps2
