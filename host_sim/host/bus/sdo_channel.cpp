#include "host_sim/host/bus/sdo_channel.hpp"

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {

using canopen::SdoClient;

void SdoChannel::write(canopen::ObjectId object, Bytes value, std::string what, OnDone done) {
  jobs_.push_back({object, std::move(value), true, std::move(what), std::move(done), {}});
}

void SdoChannel::read(canopen::ObjectId object, std::size_t most, std::string what, OnRead done) {
  jobs_.push_back({object, Bytes(most), false, std::move(what), {}, std::move(done)});
}

void SdoChannel::clear() {
  jobs_.clear();
  if (client_.in_block_download()) client_.cancel(canopen::AbortCode::general);
  keep_last_word();
  client_ = {};
  started_ = false;
  failure_.clear();
  abort_code_ = canopen::AbortCode::none;
  refused_ = false;
}

// An abort leaves before the next transfer begins; a server in a block download waits for it.
void SdoChannel::keep_last_word() {
  const bool waits = outgoing_ && request_[0] == canopen::kSdoAbort;
  const bool ended = client_.state() == SdoClient::State::failed;
  outgoing_ = (ended && client_.request(request_)) || waits;
}

void SdoChannel::receive(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (frame.id != canopen::kSdoResponse + node_ || frame.size != 8) return;
  client_.response(frame.data, now_us);
  advance(now_us);
}

void SdoChannel::poll(std::uint64_t now_us) {
  if (jobs_.empty()) return;
  client_.poll(now_us);
  advance(now_us);
}

void SdoChannel::advance(std::uint64_t now_us) {
  if (started_ && client_.state() == SdoClient::State::done) {
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    started_ = false;
    job.bytes.resize(client_.transferred());
    if (job.written) job.written();
    if (job.read) job.read(job.bytes);
  } else if (started_ && client_.state() == SdoClient::State::failed) {
    const Job& job = jobs_.front();
    abort_code_ = client_.abort_code();
    refused_ = client_.aborted_by_server();
    failed_ = job.object;
    failure_ = fmt::format("node {}: {} ({:04X}h:{:02X}): {} [abort {:08X}h]", node_, job.what,
                           job.object.index, job.object.sub, canopen::sentence(abort_code_),
                           static_cast<std::uint32_t>(abort_code_));
    jobs_.clear();
    started_ = false;
    keep_last_word();
  }
  if (started_ || jobs_.empty()) return;
  started_ = true;
  client_.set_timeout_us(timeout_us_);
  Job& job = jobs_.front();
  if (job.writing) {
    client_.download(job.object, {job.bytes.data(), job.bytes.size()}, now_us);
  } else {
    client_.upload(job.object, {job.bytes.data(), job.bytes.size()}, now_us);
  }
}

bool SdoChannel::offer(hal::CanFrame& frame) {
  if (!outgoing_) outgoing_ = client_.request(request_);
  if (!outgoing_) return false;
  frame = {static_cast<std::uint16_t>(canopen::kSdoRequest + node_), 8, request_};
  return true;
}

}  // namespace volcomp::host
