#pragma once
// CAN frames over a pair of byte pipes, turn by turn: how firmware on an emulated board is joined
// to a simulated bus. No clock matters: the firmware waits for the host's turn, the host for the
// firmware's, so that a run repeats itself bit for bit.
//
// A pipe carries records of 16 bytes, all numbers little-endian:
//
//   id u32 | size u8 | 0 0 0 | data 8 bytes
//   0…0x7FF        a CAN frame; data zero beyond size
//   0xFFFFFFFE     end of turn; data: u64, the sender's clock in µs
//   0xFFFFFFFF     quit, host → node only; data zero
//
// One turn is one tick of the node: the host writes its frames and the end of its turn into
// `to_node`, the node reads them, works, and writes its own frames and end into `from_node`. The
// node's clock is that of the host's end of turn: a millisecond more than the last time, unless the
// host sets another time. The pipes are FIFOs in one folder. The host makes them; both ends open
// `to_node` first.
//
// A whole number of records fits every pipe buffer and PIPE_BUF (POSIX), so none is ever torn.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/bytes.hpp"
#include "hal/can_port.hpp"

namespace volcomp::hal {

inline constexpr const char* kPipeToNode = "to_node";
inline constexpr const char* kPipeFromNode = "from_node";
inline constexpr std::uint32_t kPipeTurn_us = 1000;

inline constexpr std::size_t kPipeRecordBytes = 16;
using PipeBytes = std::array<std::uint8_t, kPipeRecordBytes>;

struct PipeRecord {
  enum class Kind : std::uint8_t { frame, end_of_turn, quit, malformed };

  Kind kind = Kind::malformed;
  CanFrame frame{};             // kind frame
  std::uint64_t sender_us = 0;  // kind end_of_turn
};

namespace pipe_layout {

inline constexpr std::size_t kId = 0;
inline constexpr std::size_t kSize = 4;
inline constexpr std::size_t kUnused = 5;
inline constexpr std::size_t kData = 8;
static_assert(kData + std::tuple_size<decltype(CanFrame::data)>::value == kPipeRecordBytes);

inline constexpr std::uint32_t kEndOfTurn = 0xFFFF'FFFE;
inline constexpr std::uint32_t kQuit = 0xFFFF'FFFF;

constexpr bool zero(const PipeBytes& bytes, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    if (bytes[i] != 0) return false;
  }
  return true;
}

constexpr PipeRecord decode_frame(const PipeBytes& bytes) {
  PipeRecord record;
  CanFrame& frame = record.frame;
  frame.id = static_cast<std::uint16_t>(load_le(&bytes[kId], 4));
  frame.size = bytes[kSize];
  if (frame.size > frame.data.size()) return {};
  if (!zero(bytes, kData + frame.size, kPipeRecordBytes)) return {};
  for (std::size_t i = 0; i < frame.size; ++i)
    frame.data[i] = bytes[kData + i];
  record.kind = PipeRecord::Kind::frame;
  return record;
}

}  // namespace pipe_layout

// The frame as hal/can_port.hpp has it: id up to 0x7FF, size up to 8, data zero beyond.
constexpr PipeBytes pipe_frame(const CanFrame& frame) {
  PipeBytes bytes{};
  store_le(&bytes[pipe_layout::kId], 4, frame.id);
  bytes[pipe_layout::kSize] = frame.size;
  for (std::size_t i = 0; i < frame.data.size(); ++i)
    bytes[pipe_layout::kData + i] = frame.data[i];
  return bytes;
}

constexpr PipeBytes pipe_end_of_turn(std::uint64_t now_us) {
  PipeBytes bytes{};
  store_le(&bytes[pipe_layout::kId], 4, pipe_layout::kEndOfTurn);
  store_le(&bytes[pipe_layout::kData], 8, now_us);
  return bytes;
}

constexpr PipeBytes pipe_quit() {
  PipeBytes bytes{};
  store_le(&bytes[pipe_layout::kId], 4, pipe_layout::kQuit);
  return bytes;
}

// Kind malformed for whatever the functions above cannot have made.
constexpr PipeRecord pipe_record(const PipeBytes& bytes) {
  using pipe_layout::kData;
  if (!pipe_layout::zero(bytes, pipe_layout::kUnused, kData)) return {};
  const auto id = static_cast<std::uint32_t>(load_le(&bytes[pipe_layout::kId], 4));
  if (id <= kMaxCanId) return pipe_layout::decode_frame(bytes);
  if (bytes[pipe_layout::kSize] != 0) return {};
  if (id == pipe_layout::kEndOfTurn)
    return {PipeRecord::Kind::end_of_turn, {}, load_le(&bytes[kData], 8)};
  if (id == pipe_layout::kQuit && pipe_layout::zero(bytes, kData, kPipeRecordBytes))
    return {PipeRecord::Kind::quit, {}, 0};
  return {};
}

static_assert(kPipeRecordBytes == 16);
static_assert(pipe_record(pipe_quit()).kind == PipeRecord::Kind::quit);
static_assert(pipe_record(pipe_end_of_turn(UINT64_MAX)).sender_us == UINT64_MAX);
static_assert(pipe_record(pipe_frame({kMaxCanId, 0, {}})).frame.id == kMaxCanId);

}  // namespace volcomp::hal
