#include "hal/loopback/frame_bits.hpp"

namespace volcomp::hal {
namespace {

constexpr std::uint32_t kPolynomial = 0x4599;

class Crc15 {
 public:
  void operator()(bool bit) {
    const bool subtract = bit != ((crc_ & 0x4000U) != 0);
    crc_ = (crc_ << 1U) & 0x7FFFU;
    if (subtract) crc_ ^= kPolynomial;
  }
  [[nodiscard]] std::uint32_t value() const { return crc_; }

 private:
  std::uint32_t crc_ = 0;
};

// A stuff bit is the opposite of the five equal ones before it and opens the next run.
class StuffCounter {
 public:
  void operator()(bool bit) {
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < 5) return;
    ++count_;
    last_ = !bit;
    run_ = 1;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  bool last_ = true;  // the idle bus is recessive and does not belong to the frame
  std::uint32_t run_ = 0;
  std::uint32_t count_ = 0;
};

// Most significant bit first.
template <class Sink>
void feed(Sink& sink, std::uint32_t value, unsigned bits) {
  while (bits-- > 0)
    sink(((value >> bits) & 1U) != 0);
}

template <class Sink>
void feed_until_crc(Sink& sink, const CanFrame& frame) {
  feed(sink, 0, 1);  // start of frame
  feed(sink, frame.id, 11);
  feed(sink, 0, 3);  // RTR, IDE and r0 of a data frame in base format are dominant
  feed(sink, frame.size, 4);
  for (std::size_t i = 0; i < frame.size; ++i)
    feed(sink, frame.data[i], 8);
}

}  // namespace

std::uint16_t frame_crc(const CanFrame& frame) {
  Crc15 crc;
  feed_until_crc(crc, frame);
  return static_cast<std::uint16_t>(crc.value());
}

std::uint32_t exact_frame_bits(const CanFrame& frame) {
  StuffCounter stuff;
  feed_until_crc(stuff, frame);
  feed(stuff, frame_crc(frame), 15);
  return nominal_frame_bits(frame.size) + stuff.count();
}

}  // namespace volcomp::hal
