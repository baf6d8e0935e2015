#pragma once
// The two ends of an SDO data stream. Server and client use the same pair: a download goes from the
// client's sender to the server's receiver, an upload the other way round.
//
// Bytes go straight from and into the memory of the caller; only the last segment of a block
// transfer is buffered, because its padding is known only afterwards.

#include "firmware/canopen/sdo_protocol.hpp"

namespace volcomp::canopen {

class SdoSender {
 public:
  // `source` must stay as it is until the transfer ends. An empty one is sent as one empty segment.
  void start(Span<const std::uint8_t> source);

  [[nodiscard]] Span<const std::uint8_t> source() const { return source_; }
  // Bytes whose sending is final: in a block transfer, those the other side has confirmed.
  [[nodiscard]] std::size_t sent() const;
  [[nodiscard]] bool all_sent() const { return sent_ == total_; }

  // The next segment of a segmented transfer; not after all_sent().
  [[nodiscard]] SdoData segment(std::uint8_t toggle);

  // From here on in blocks of 1…127 segments.
  void start_blocks(std::uint8_t segments, bool with_crc);
  // The next segment of the block; false when it is complete.
  [[nodiscard]] bool block_segment(SdoData& out);
  // The other side has the segments 1…`last_good` of this block and requests `segments` in the
  // next. Refuses block_sequence, block_size.
  [[nodiscard]] AbortCode confirmed(std::uint8_t last_good, std::uint8_t segments);
  // After all_sent().
  [[nodiscard]] SdoData block_end(std::uint8_t command) const;

 private:
  [[nodiscard]] Span<const std::uint8_t> bytes(std::size_t first_segment, std::size_t count) const;
  [[nodiscard]] SdoData make_segment(std::size_t number) const;

  Span<const std::uint8_t> source_;
  std::size_t total_ = 0;  // segments
  std::size_t sent_ = 0;   // confirmed segments
  std::uint8_t in_block_ = 0;
  std::uint8_t block_segments_ = 0;
  std::uint16_t crc_ = 0;
  bool with_crc_ = false;
};

class SdoReceiver {
 public:
  // Refuses with too_long what can never fit into `sink`.
  [[nodiscard]] AbortCode start(Span<std::uint8_t> sink, std::optional<std::size_t> announced);

  [[nodiscard]] std::size_t received() const { return received_; }

  // The bytes inside an initiate frame. Without a count there are as many as the sink takes.
  [[nodiscard]] AbortCode expedited(const SdoData& frame);
  // Refuses toggle_bit, too_long.
  [[nodiscard]] AbortCode segment(const SdoData& frame, std::uint8_t toggle);
  // Nothing more will come: refuses too_short.
  [[nodiscard]] AbortCode complete() const;

  void start_blocks(bool with_crc);
  // Takes the segment if it is the next one; one after a gap is ignored, the sender will repeat it.
  // Refuses block_sequence, too_long.
  [[nodiscard]] AbortCode block_segment(const SdoData& frame);
  // The sender waits for a confirmation now.
  [[nodiscard]] bool confirmation_due() const { return confirmation_due_; }
  // The segment to name in the confirmation; begins the next block.
  [[nodiscard]] std::uint8_t confirm();
  // The last segment has come; block_end() is next.
  [[nodiscard]] bool all_segments() const { return all_segments_; }
  // Refuses too_long, too_short, block_crc.
  [[nodiscard]] AbortCode block_end(const SdoData& frame);

 private:
  [[nodiscard]] AbortCode append(Span<const std::uint8_t> bytes);

  Span<std::uint8_t> sink_;
  std::optional<std::size_t> announced_;
  std::size_t received_ = 0;
  SdoData last_segment_{};
  std::uint16_t crc_ = 0;
  std::uint8_t last_good_ = 0;
  bool with_crc_ = false;
  bool confirmation_due_ = false;
  bool all_segments_ = false;
};

}  // namespace volcomp::canopen
