#include "firmware/canopen/sdo_client.hpp"

#include <algorithm>

namespace volcomp::canopen {

void SdoClient::begin(ObjectId object, std::uint64_t now_us) {
  object_ = object;
  last_active_us_ = now_us;
  state_ = State::busy;
  abort_code_ = AbortCode::none;
  aborted_by_server_ = sending_ = prompted_ = false;
}

bool SdoClient::request(SdoData& out) {
  if (request_waiting_) {
    out = request_;
    request_waiting_ = false;
    return true;
  }
  if (state_ != State::busy || phase_ != Phase::block_download || !sender_.block_segment(out))
    return false;
  sending_ = true;
  return true;
}

void SdoClient::response(const SdoData& frame, std::uint64_t now_us) {
  if (state_ != State::busy) return;
  last_active_us_ = now_us;
  prompted_ = false;
  if (frame[0] == kSdoAbort) return aborted(static_cast<AbortCode>(number_of(frame)));
  switch (phase_) {
    case Phase::initiate_download:
      return download_initiated(frame);
    case Phase::download:
      return download_confirmed(frame);
    case Phase::initiate_upload:
      return upload_initiated(frame);
    case Phase::upload:
      return upload_segment(frame);
    case Phase::initiate_block_download:
      return block_download_initiated(frame);
    case Phase::block_download:
      return block_download_confirmed(frame);
    case Phase::block_download_end:
      return block_download_ended(frame);
    case Phase::initiate_block_upload:
      return block_upload_initiated(frame);
    case Phase::block_upload:
      return block_upload_segment(frame);
    case Phase::block_upload_end:
      return block_upload_ended(frame);
  }
}

// A server without block transfer does not know the command; everything else is final.
void SdoClient::aborted(AbortCode code) {
  const bool no_blocks = code == AbortCode::unknown_command;
  if (no_blocks && phase_ == Phase::initiate_block_download) return start_download();
  if (no_blocks && phase_ == Phase::initiate_block_upload) return start_upload();
  finish(code, true);
  // As long as segments may be under way, the server takes a new request for one of them.
  if (phase_ != Phase::block_download && phase_ != Phase::block_download_end) return;
  request_ = abort_frame(object_, code);
  request_waiting_ = true;
}

void SdoClient::poll(std::uint64_t now_us) {
  if (state_ != State::busy) return;
  // On a slow bus a block takes longer than the timeout, and the server is silent meanwhile.
  if (sending_) last_active_us_ = now_us;
  sending_ = false;
  const std::uint64_t silence_us = now_us - last_active_us_;
  if (silence_us >= timeout_us_) return cancel(AbortCode::timeout);
  // If the end of a block is lost, both sides wait for each other.
  if (phase_ != Phase::block_upload || prompted_ || silence_us < timeout_us_ / 2) return;
  prompted_ = true;
  confirm_block();
}

void SdoClient::cancel(AbortCode why) {
  if (state_ != State::busy) return;
  request_ = abort_frame(object_, why);
  request_waiting_ = true;
  finish(why, false);
}

std::size_t SdoClient::transferred() const {
  if (!writing_) return receiver_.received();
  return state_ == State::done ? sender_.source().size() : sender_.sent();
}

// --- download

void SdoClient::download(ObjectId object, Span<const std::uint8_t> source, std::uint64_t now_us) {
  begin(object, now_us);
  writing_ = true;
  sender_.start(source);
  if (fits_expedited(source.size()) || source.size() < block_threshold_) return start_download();
  ask(Phase::initiate_block_download,
      object_frame(ccs::kBlockDownload | kBlockCrc | kBlockSizeIndicated, object, source.size()));
}

void SdoClient::start_download() {
  ask(Phase::initiate_download, initiate_frame(ccs::kInitiateDownload, object_, sender_.source()));
}

void SdoClient::download_initiated(const SdoData& frame) {
  if (!answers(frame, scs::kInitiateDownload)) return;
  if (fits_expedited(sender_.source().size())) return finish(AbortCode::none, false);
  toggle_ = 0;
  ask(Phase::download, sender_.segment(ccs::kDownloadSegment));
}

void SdoClient::download_confirmed(const SdoData& frame) {
  if (command_of(frame) != scs::kDownloadSegment) return cancel(AbortCode::unknown_command);
  if ((frame[0] & kToggle) != toggle_) return cancel(AbortCode::toggle_bit);
  if (sender_.all_sent()) return finish(AbortCode::none, false);
  toggle_ ^= kToggle;
  ask(Phase::download, sender_.segment(ccs::kDownloadSegment | toggle_));
}

// --- upload

void SdoClient::upload(ObjectId object, Span<std::uint8_t> sink, std::uint64_t now_us) {
  begin(object, now_us);
  writing_ = false;
  sink_ = sink;
  receiver_ = {};
  if (fits_expedited(sink.size()) || sink.size() < block_threshold_) return start_upload();
  SdoData frame = object_frame(ccs::kBlockUpload | kBlockCrc, object, kMostBlockSegments);
  const std::size_t below = block_threshold_ == 0 ? 0 : block_threshold_ - 1;
  frame[5] = static_cast<std::uint8_t>(std::min<std::size_t>(below, UINT8_MAX));
  ask(Phase::initiate_block_upload, frame);
}

void SdoClient::start_upload() {
  ask(Phase::initiate_upload, object_frame(ccs::kInitiateUpload, object_));
}

void SdoClient::upload_initiated(const SdoData& frame) {
  if (!answers(frame, scs::kInitiateUpload)) return;
  if (!accept(receiver_.start(sink_, announced_size(frame)))) return;
  if (is_expedited(frame)) {
    if (accept(receiver_.expedited(frame))) finish(AbortCode::none, false);
    return;
  }
  toggle_ = 0;
  ask(Phase::upload, {ccs::kUploadSegment});
}

void SdoClient::upload_segment(const SdoData& frame) {
  if (command_of(frame) != scs::kUploadSegment) return cancel(AbortCode::unknown_command);
  if (!accept(receiver_.segment(frame, toggle_))) return;
  if ((frame[0] & kLastSegment) != 0) {
    if (accept(receiver_.complete())) finish(AbortCode::none, false);
    return;
  }
  toggle_ ^= kToggle;
  ask(Phase::upload, {static_cast<std::uint8_t>(ccs::kUploadSegment | toggle_)});
}

// --- block download

void SdoClient::block_download_initiated(const SdoData& frame) {
  if (!answers(frame, scs::kBlockDownload)) return;
  const std::uint8_t segments = frame[4];
  if (segments == 0 || segments > kMostBlockSegments) return cancel(AbortCode::block_size);
  sender_.start_blocks(segments, (frame[0] & kBlockCrc) != 0);
  phase_ = Phase::block_download;
}

void SdoClient::block_download_confirmed(const SdoData& frame) {
  if (frame[0] != (scs::kBlockDownload | kBlockConfirm)) return cancel(AbortCode::unknown_command);
  if (!accept(sender_.confirmed(frame[1], frame[2]))) return;
  if (sender_.all_sent()) ask(Phase::block_download_end, sender_.block_end(ccs::kBlockDownload));
}

void SdoClient::block_download_ended(const SdoData& frame) {
  if (frame[0] != (scs::kBlockDownload | kBlockEnd)) return cancel(AbortCode::unknown_command);
  finish(AbortCode::none, false);
}

// --- block upload

void SdoClient::block_upload_initiated(const SdoData& frame) {
  // The value is short and the server switched to a normal upload.
  if (command_of(frame) == scs::kInitiateUpload) return upload_initiated(frame);
  if (!answers(frame, scs::kBlockUpload)) return;
  if (!accept(receiver_.start(sink_, announced_block_size(frame)))) return;
  receiver_.start_blocks((frame[0] & kBlockCrc) != 0);
  ask(Phase::block_upload, {ccs::kBlockUpload | kBlockStart});
}

void SdoClient::block_upload_segment(const SdoData& frame) {
  if (!accept(receiver_.block_segment(frame))) return;
  if (receiver_.confirmation_due()) confirm_block();
}

void SdoClient::confirm_block() {
  const SdoData frame = confirm_frame(ccs::kBlockUpload, receiver_.confirm());
  ask(receiver_.all_segments() ? Phase::block_upload_end : Phase::block_upload, frame);
}

void SdoClient::block_upload_ended(const SdoData& frame) {
  if (command_of(frame) != scs::kBlockUpload || (frame[0] & kSenderSubcommand) != kBlockEnd)
    return cancel(AbortCode::unknown_command);
  if (!accept(receiver_.block_end(frame))) return;
  ask(Phase::block_upload_end, {ccs::kBlockUpload | kBlockEnd});
  finish(AbortCode::none, false);
}

// --- common

// Whether this answers the request of the transfer. A late answer to an earlier request is ignored,
// anything else ends the transfer.
bool SdoClient::answers(const SdoData& frame, std::uint8_t command) {
  if (command_of(frame) != command) {
    cancel(AbortCode::unknown_command);
    return false;
  }
  return object_of(frame) == object_;
}

bool SdoClient::accept(AbortCode code) {
  if (code != AbortCode::none) cancel(code);
  return code == AbortCode::none;
}

void SdoClient::ask(Phase next, const SdoData& frame) {
  phase_ = next;
  request_ = frame;
  request_waiting_ = true;
}

void SdoClient::finish(AbortCode code, bool by_server) {
  state_ = code == AbortCode::none ? State::done : State::failed;
  abort_code_ = code;
  aborted_by_server_ = by_server;
}

}  // namespace volcomp::canopen
