#include "firmware/canopen/sdo_transfer.hpp"

#include <algorithm>

#include "firmware/canopen/crc16.hpp"

namespace volcomp::canopen {

// --- SdoSender

void SdoSender::start(Span<const std::uint8_t> source) {
  *this = {};
  source_ = source;
  total_ = std::max<std::size_t>(1, (source.size() + kSegmentBytes - 1) / kSegmentBytes);
}

std::size_t SdoSender::sent() const { return std::min(source_.size(), kSegmentBytes * sent_); }

Span<const std::uint8_t> SdoSender::bytes(std::size_t first_segment, std::size_t count) const {
  const std::size_t from = kSegmentBytes * first_segment;
  return {source_.data() + from, std::min(kSegmentBytes * count, source_.size() - from)};
}

SdoData SdoSender::make_segment(std::size_t number) const {
  SdoData frame{};
  const Span<const std::uint8_t> content = bytes(number, 1);
  std::copy(content.begin(), content.end(), frame.begin() + 1);
  return frame;
}

SdoData SdoSender::segment(std::uint8_t toggle) {
  SdoData frame = make_segment(sent_);
  const auto unused = static_cast<unsigned>(kSegmentBytes - bytes(sent_, 1).size());
  ++sent_;
  frame[0] = static_cast<std::uint8_t>(toggle | unused << 1U | (all_sent() ? kLastSegment : 0U));
  return frame;
}

void SdoSender::start_blocks(std::uint8_t segments, bool with_crc) {
  block_segments_ = segments;
  with_crc_ = with_crc;
}

bool SdoSender::block_segment(SdoData& out) {
  const std::size_t number = sent_ + in_block_;
  if (in_block_ == block_segments_ || number == total_) return false;
  out = make_segment(number);
  ++in_block_;
  out[0] = static_cast<std::uint8_t>(in_block_ | (number + 1 == total_ ? kLastBlockSegment : 0U));
  return true;
}

AbortCode SdoSender::confirmed(std::uint8_t last_good, std::uint8_t segments) {
  if (last_good > in_block_) return AbortCode::block_sequence;
  if (with_crc_) crc_ = crc16(bytes(sent_, last_good), crc_);
  sent_ += last_good;
  in_block_ = 0;
  if (all_sent()) return AbortCode::none;
  if (segments == 0 || segments > kMostBlockSegments) return AbortCode::block_size;
  block_segments_ = segments;
  return AbortCode::none;
}

SdoData SdoSender::block_end(std::uint8_t command) const {
  const auto unused = static_cast<unsigned>(kSegmentBytes * total_ - source_.size());
  SdoData frame{static_cast<std::uint8_t>(command | unused << 2U | kBlockEnd)};
  store_le(frame.data() + 1, 2, crc_);
  return frame;
}

// --- SdoReceiver

AbortCode SdoReceiver::start(Span<std::uint8_t> sink, std::optional<std::size_t> announced) {
  *this = {};
  sink_ = sink;
  announced_ = announced;
  return announced.value_or(0) > sink.size() ? AbortCode::too_long : AbortCode::none;
}

AbortCode SdoReceiver::append(Span<const std::uint8_t> bytes) {
  const std::size_t limit = announced_.value_or(sink_.size());
  if (bytes.size() > limit - received_) return AbortCode::too_long;
  if (with_crc_) crc_ = crc16(bytes, crc_);
  std::copy(bytes.begin(), bytes.end(), sink_.begin() + received_);
  received_ += bytes.size();
  return AbortCode::none;
}

AbortCode SdoReceiver::expedited(const SdoData& frame) {
  return append({frame.data() + 4, announced_.value_or(std::min(kExpeditedBytes, sink_.size()))});
}

AbortCode SdoReceiver::segment(const SdoData& frame, std::uint8_t toggle) {
  if ((frame[0] & kToggle) != toggle) return AbortCode::toggle_bit;
  const std::size_t unused = (frame[0] >> 1U) & 7U;
  return append({frame.data() + 1, kSegmentBytes - unused});
}

AbortCode SdoReceiver::complete() const {
  return received_ < announced_.value_or(0) ? AbortCode::too_short : AbortCode::none;
}

void SdoReceiver::start_blocks(bool with_crc) { with_crc_ = with_crc; }

AbortCode SdoReceiver::block_segment(const SdoData& frame) {
  const std::uint8_t number = frame[0] & 0x7FU;
  const bool last = (frame[0] & kLastBlockSegment) != 0;
  if (number == 0) return AbortCode::block_sequence;
  confirmation_due_ = last || number == kMostBlockSegments;
  if (number != last_good_ + 1) return AbortCode::none;
  last_good_ = number;
  all_segments_ = last;
  if (!last) return append({frame.data() + 1, kSegmentBytes});
  last_segment_ = frame;
  return AbortCode::none;
}

std::uint8_t SdoReceiver::confirm() {
  const std::uint8_t last_good = last_good_;
  last_good_ = 0;
  confirmation_due_ = false;
  return last_good;
}

AbortCode SdoReceiver::block_end(const SdoData& frame) {
  const std::size_t unused = (frame[0] >> 2U) & 7U;
  const AbortCode code = append({last_segment_.data() + 1, kSegmentBytes - unused});
  if (code != AbortCode::none) return code;
  const bool damaged = with_crc_ && load_le(frame.data() + 1, 2) != crc_;
  return damaged ? AbortCode::block_crc : complete();
}

}  // namespace volcomp::canopen
