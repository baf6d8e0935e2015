#pragma once
// The SDO server of a device (CiA 301, section 7.2.4): expedited, segmented and block transfer with
// CRC in both directions. One transfer at a time; the caller hands frames in, takes them out, and
// passes the time.
//
//   server.request(frame, now);  or  server.poll(now);
//   while (server.response(frame)) send(frame);
//
// Incoming bytes go straight into the object's memory, outgoing ones come straight from it.
//
// A segment of a block has its number in the first byte and can look like any request but the abort
// 80h (CiA 301, section 7.2.4.3). After a block download has failed, segments that are still under
// way must not be executed: until the client aborts, too, or is silent for the timeout, everything
// is dropped.

#include "firmware/canopen/sdo_transfer.hpp"

namespace volcomp::canopen {

class SdoServer {
 public:
  // `access` must outlive the server.
  explicit SdoServer(ObjectAccess& access) : access_(access) {}

  // A transfer without a request for that long is aborted.
  void set_timeout_us(std::uint64_t timeout_us) { timeout_us_ = timeout_us; }

  // One frame from the client. An initiate request in the middle of a transfer drops that transfer,
  // unless it is a block download.
  void request(const SdoData& frame, std::uint64_t now_us);
  // The next frame to send, false when there is none: one per request, up to 127 segments after the
  // request for a block, each made at the call.
  [[nodiscard]] bool response(SdoData& out);
  // Time passed; may produce a response.
  void poll(std::uint64_t now_us);
  // There is a response, now.
  [[nodiscard]] bool busy() const { return response_waiting_ || phase_ == Phase::block_upload; }
  // When poll() takes the client for silent, if no request comes; UINT64_MAX: never.
  [[nodiscard]] std::uint64_t silent_at_us() const {
    return phase_ == Phase::idle ? UINT64_MAX : last_active_us_ + timeout_us_;
  }
  // Communication reset: drops transfer and response without an abort.
  void reset();

 private:
  enum class Phase : std::uint8_t {
    idle,
    download,
    upload,
    block_download,
    block_download_end,
    block_download_aborted,  // segments that were under way when it failed may still arrive
    block_upload_start,
    block_upload,
    block_upload_end,
  };

  void initiate_download(const SdoData& frame);
  void download_segment(const SdoData& frame);
  void initiate_upload(const SdoData& frame);
  void upload_segment(const SdoData& frame);
  void answer_upload();
  void block_download(const SdoData& frame);
  void initiate_block_download(const SdoData& frame);
  void block_download_frame(const SdoData& frame);
  void block_download_segment(const SdoData& frame);
  void end_block_download(const SdoData& frame);
  void confirm_block();
  void block_upload(const SdoData& frame);
  void initiate_block_upload(const SdoData& frame);
  void block_upload_confirmed(const SdoData& frame);

  [[nodiscard]] bool open_download(const SdoData& frame, std::optional<std::size_t> announced);
  [[nodiscard]] bool open_upload(const SdoData& frame);
  [[nodiscard]] bool in(Phase phase);
  void finish_download(const SdoData& response);
  void answer(const SdoData& frame);
  void abort(AbortCode code);
  [[nodiscard]] bool in_block_download() const;
  void drop();

  ObjectAccess& access_;
  SdoSender sender_;
  SdoReceiver receiver_;
  ObjectId object_{};
  SdoData response_{};
  SdoData last_request_{};
  std::uint64_t timeout_us_ = kSdoTimeout_us;
  std::uint64_t last_active_us_ = 0;
  Phase phase_ = Phase::idle;
  std::uint8_t toggle_ = 0;
  bool response_waiting_ = false;
  bool download_open_ = false;  // begun at the ObjectAccess, neither finished nor abandoned
  bool sending_ = false;        // block segments left since the last poll
};

}  // namespace volcomp::canopen
