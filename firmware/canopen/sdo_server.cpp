#include "firmware/canopen/sdo_server.hpp"

namespace volcomp::canopen {

void SdoServer::request(const SdoData& frame, std::uint64_t now_us) {
  last_active_us_ = now_us;
  const bool again = frame == last_request_;
  last_request_ = frame;
  if (frame[0] == kSdoAbort) return reset();
  if (phase_ == Phase::block_download_aborted) return;
  if (in_block_download()) {
    // CAN may deliver a frame twice, and a second answer would make the client repeat the block.
    if (!again) block_download_frame(frame);
    return;
  }
  switch (command_of(frame)) {
    case ccs::kInitiateDownload:
      return initiate_download(frame);
    case ccs::kDownloadSegment:
      return download_segment(frame);
    case ccs::kInitiateUpload:
      return initiate_upload(frame);
    case ccs::kUploadSegment:
      return upload_segment(frame);
    case ccs::kBlockDownload:
      return block_download(frame);
    case ccs::kBlockUpload:
      return block_upload(frame);
    default:
      return abort(AbortCode::unknown_command);
  }
}

bool SdoServer::response(SdoData& out) {
  if (response_waiting_) {
    out = response_;
    response_waiting_ = false;
    return true;
  }
  if (phase_ != Phase::block_upload || !sender_.block_segment(out)) return false;
  sending_ = true;
  return true;
}

void SdoServer::poll(std::uint64_t now_us) {
  // On a slow bus a block takes longer than the timeout, and the client is silent meanwhile.
  if (sending_) last_active_us_ = now_us;
  sending_ = false;
  if (phase_ == Phase::idle) return;
  const std::uint64_t silence_us = now_us - last_active_us_;
  if (silence_us >= timeout_us_) {
    if (phase_ == Phase::block_download_aborted) return drop();
    last_active_us_ = now_us;
    abort(AbortCode::timeout);
  }
}

void SdoServer::reset() {
  drop();
  response_waiting_ = false;
}

// --- download

bool SdoServer::open_download(const SdoData& frame, std::optional<std::size_t> announced) {
  drop();
  object_ = object_of(frame);
  Span<std::uint8_t> sink;
  AbortCode code = access_.begin_download(object_, announced.value_or(0), sink);
  download_open_ = code == AbortCode::none;
  if (download_open_) code = receiver_.start(sink, announced);
  if (code != AbortCode::none) abort(code);
  return code == AbortCode::none;
}

void SdoServer::finish_download(const SdoData& response) {
  AbortCode code = receiver_.complete();
  if (code == AbortCode::none) {
    phase_ = Phase::idle;
    download_open_ = false;
    code = access_.finish_download(object_, receiver_.received());
  }
  if (code != AbortCode::none) return abort(code);
  drop();
  answer(response);
}

void SdoServer::initiate_download(const SdoData& frame) {
  if (!open_download(frame, announced_size(frame))) return;
  const SdoData response = object_frame(scs::kInitiateDownload, object_);
  if (is_expedited(frame)) {
    const AbortCode code = receiver_.expedited(frame);
    return code == AbortCode::none ? finish_download(response) : abort(code);
  }
  phase_ = Phase::download;
  toggle_ = 0;
  answer(response);
}

void SdoServer::download_segment(const SdoData& frame) {
  if (!in(Phase::download)) return;
  const AbortCode code = receiver_.segment(frame, toggle_);
  if (code != AbortCode::none) return abort(code);
  const SdoData response{static_cast<std::uint8_t>(scs::kDownloadSegment | toggle_)};
  if ((frame[0] & kLastSegment) != 0) return finish_download(response);
  toggle_ ^= kToggle;
  answer(response);
}

// --- upload

bool SdoServer::open_upload(const SdoData& frame) {
  drop();
  object_ = object_of(frame);
  Span<const std::uint8_t> source;
  const AbortCode code = access_.begin_upload(object_, source);
  if (code != AbortCode::none) abort(code);
  sender_.start(source);
  return code == AbortCode::none;
}

void SdoServer::initiate_upload(const SdoData& frame) {
  if (open_upload(frame)) answer_upload();
}

void SdoServer::answer_upload() {
  answer(initiate_frame(scs::kInitiateUpload, object_, sender_.source()));
  if (fits_expedited(sender_.source().size())) return drop();
  phase_ = Phase::upload;
  toggle_ = 0;
}

void SdoServer::upload_segment(const SdoData& frame) {
  if (!in(Phase::upload)) return;
  if ((frame[0] & kToggle) != toggle_) return abort(AbortCode::toggle_bit);
  answer(sender_.segment(scs::kUploadSegment | toggle_));
  toggle_ ^= kToggle;
  if (sender_.all_sent()) drop();
}

// --- block download

void SdoServer::block_download(const SdoData& frame) {
  if ((frame[0] & kSenderSubcommand) == kBlockInitiate) return initiate_block_download(frame);
  abort(AbortCode::unknown_command);
}

// Segments fill the whole first byte: it holds no command then.
void SdoServer::block_download_frame(const SdoData& frame) {
  if (phase_ == Phase::block_download) return block_download_segment(frame);
  const bool end =
      command_of(frame) == ccs::kBlockDownload && (frame[0] & kSenderSubcommand) == kBlockEnd;
  return end ? end_block_download(frame) : abort(AbortCode::unknown_command);
}

void SdoServer::end_block_download(const SdoData& frame) {
  const AbortCode code = receiver_.block_end(frame);
  if (code != AbortCode::none) return abort(code);
  finish_download({scs::kBlockDownload | kBlockEnd});
}

void SdoServer::initiate_block_download(const SdoData& frame) {
  if (!open_download(frame, announced_block_size(frame))) return;
  receiver_.start_blocks((frame[0] & kBlockCrc) != 0);
  phase_ = Phase::block_download;
  answer(object_frame(scs::kBlockDownload | kBlockCrc, object_, kMostBlockSegments));
}

void SdoServer::block_download_segment(const SdoData& frame) {
  const AbortCode code = receiver_.block_segment(frame);
  if (code != AbortCode::none) return abort(code);
  if (receiver_.confirmation_due()) confirm_block();
}

void SdoServer::confirm_block() {
  answer(confirm_frame(scs::kBlockDownload, receiver_.confirm()));
  if (receiver_.all_segments()) phase_ = Phase::block_download_end;
}

// --- block upload

void SdoServer::block_upload(const SdoData& frame) {
  switch (frame[0] & kReceiverSubcommand) {
    case kBlockInitiate:
      return initiate_block_upload(frame);
    case kBlockStart:
      if (in(Phase::block_upload_start)) phase_ = Phase::block_upload;
      return;
    case kBlockConfirm:
      return block_upload_confirmed(frame);
    default:
      if (in(Phase::block_upload_end)) drop();
      return;
  }
}

void SdoServer::initiate_block_upload(const SdoData& frame) {
  const std::uint8_t segments = frame[4];
  const std::uint8_t switch_threshold = frame[5];
  if (!open_upload(frame)) return;
  if (segments == 0 || segments > kMostBlockSegments) return abort(AbortCode::block_size);
  // CiA 301, section 7.2.4.3.12: up to this size a block would only cost time (0: never).
  const std::size_t size = sender_.source().size();
  if (switch_threshold != 0 && size <= switch_threshold) return answer_upload();
  sender_.start_blocks(segments, (frame[0] & kBlockCrc) != 0);
  phase_ = Phase::block_upload_start;
  answer(object_frame(scs::kBlockUpload | kBlockCrc | kBlockSizeIndicated, object_, size));
}

void SdoServer::block_upload_confirmed(const SdoData& frame) {
  if (!in(Phase::block_upload)) return;
  const AbortCode code = sender_.confirmed(frame[1], frame[2]);
  if (code != AbortCode::none) return abort(code);
  if (!sender_.all_sent()) return;
  phase_ = Phase::block_upload_end;
  answer(sender_.block_end(scs::kBlockUpload));
}

// --- common

// Whether a request belongs to the transfer that is running; aborts that transfer if not.
bool SdoServer::in(Phase phase) {
  if (phase_ == phase) return true;
  abort(AbortCode::unknown_command);
  return false;
}

void SdoServer::answer(const SdoData& frame) {
  response_ = frame;
  response_waiting_ = true;
}

void SdoServer::abort(AbortCode code) {
  const bool inside_block = in_block_download();
  answer(abort_frame(object_, code));
  drop();
  if (inside_block) phase_ = Phase::block_download_aborted;
}

bool SdoServer::in_block_download() const {
  return phase_ == Phase::block_download || phase_ == Phase::block_download_end;
}

void SdoServer::drop() {
  if (download_open_) access_.abandon_download(object_);
  download_open_ = false;
  phase_ = Phase::idle;
  object_ = {};
}

}  // namespace volcomp::canopen
