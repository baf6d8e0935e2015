#pragma once
// An SDO client (CiA 301, section 7.2.4): reads and writes objects of one server, one transfer at a
// time. Chooses the kind of transfer itself: up to 4 bytes expedited, from the block threshold on
// in blocks with CRC, everything between segmented. The caller hands frames in, takes them out, and
// passes the time.
//
//   client.download({0x2110, 1}, image, now);
//   while (client.state() == SdoClient::State::busy) {
//     while (client.request(frame)) send(frame);
//     client.response(received, now);  // whenever one arrives
//     client.poll(now);
//   }
//   while (client.request(frame)) send(frame);  // the last word: an end or an abort

#include "firmware/canopen/sdo_transfer.hpp"

namespace volcomp::canopen {

class SdoClient {
 public:
  enum class State : std::uint8_t { idle, busy, done, failed };

  // A server that is silent for that long fails the transfer. After half of it in the middle of a
  // block upload the client confirms what has arrived, once, in case the end of the block was lost.
  void set_timeout_us(std::uint64_t timeout_us) { timeout_us_ = timeout_us; }
  // Blocks are used for so many bytes and more.
  void set_block_threshold(std::size_t bytes) { block_threshold_ = bytes; }

  // Start a transfer and forget a running one. The bytes stay with the caller and must not move
  // until the state is no longer busy. An upload that is longer than `sink` fails with too_long.
  void download(ObjectId object, Span<const std::uint8_t> source, std::uint64_t now_us);
  void upload(ObjectId object, Span<std::uint8_t> sink, std::uint64_t now_us);
  // Aborts the transfer and sends the server the reason. Does nothing when no transfer is running.
  void cancel(AbortCode why);

  // The next frame to send, false when there is none at the moment.
  [[nodiscard]] bool request(SdoData& out);
  // One frame from the server.
  void response(const SdoData& frame, std::uint64_t now_us);
  // Time passed; may produce a request.
  void poll(std::uint64_t now_us);

  [[nodiscard]] State state() const { return state_; }
  // The server takes whatever comes for a segment: to be left with cancel() only.
  [[nodiscard]] bool in_block_download() const { return state_ == State::busy && sends_blocks(); }
  // Why the transfer failed, and which side ended it.
  [[nodiscard]] AbortCode abort_code() const { return abort_code_; }
  [[nodiscard]] bool aborted_by_server() const { return aborted_by_server_; }
  // Bytes so far; after success the size of the value.
  [[nodiscard]] std::size_t transferred() const;

 private:
  enum class Phase : std::uint8_t {  // what the client waits for
    initiate_download,
    download,
    initiate_upload,
    upload,
    initiate_block_download,
    block_download,
    block_download_end,
    initiate_block_upload,
    block_upload,
    block_upload_end,
  };

  void start_download();
  void start_upload();
  void download_initiated(const SdoData& frame);
  void download_confirmed(const SdoData& frame);
  void upload_initiated(const SdoData& frame);
  void upload_segment(const SdoData& frame);
  void block_download_initiated(const SdoData& frame);
  void block_download_confirmed(const SdoData& frame);
  void block_download_ended(const SdoData& frame);
  void block_upload_initiated(const SdoData& frame);
  void block_upload_segment(const SdoData& frame);
  void block_upload_ended(const SdoData& frame);

  void begin(ObjectId object, std::uint64_t now_us);
  void aborted(AbortCode code);
  [[nodiscard]] bool sends_blocks() const {
    return phase_ == Phase::initiate_block_download || phase_ == Phase::block_download ||
           phase_ == Phase::block_download_end;
  }
  void confirm_block();
  [[nodiscard]] bool answers(const SdoData& frame, std::uint8_t command);
  [[nodiscard]] bool accept(AbortCode code);
  void ask(Phase next, const SdoData& frame);
  void finish(AbortCode code, bool by_server);

  SdoSender sender_;
  SdoReceiver receiver_;
  Span<std::uint8_t> sink_;
  ObjectId object_{};
  SdoData request_{};
  std::size_t block_threshold_ = 64;
  std::uint64_t timeout_us_ = kSdoTimeout_us;
  std::uint64_t last_active_us_ = 0;
  AbortCode abort_code_ = AbortCode::none;
  State state_ = State::idle;
  Phase phase_ = Phase::initiate_download;
  std::uint8_t toggle_ = 0;
  bool writing_ = false;
  bool request_waiting_ = false;
  bool aborted_by_server_ = false;
  bool sending_ = false;   // block segments left since the last poll
  bool prompted_ = false;  // the server, since its last response
};

}  // namespace volcomp::canopen
