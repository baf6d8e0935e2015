#include "host_sim/host/bus/node_client.hpp"

#include <utility>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/exchange.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::NmtState;

NodeClient::NodeClient(std::uint8_t node_id, Pump pump)
    : node_id_(node_id), pump_(std::move(pump)), channel_(node_id) {}

SdoChannel::Bytes NodeClient::read(canopen::ObjectId object, std::size_t most,
                                   const std::string& what) {
  SdoChannel::Bytes value;
  channel_.read(object, most, what, [&value](const SdoChannel::Bytes& bytes) { value = bytes; });
  finish_transfer({});
  return value;
}

void NodeClient::write(canopen::ObjectId object, SdoChannel::Bytes value, const std::string& what,
                       const Progress& progress) {
  channel_.write(object, std::move(value), what);
  finish_transfer(progress);
}

void NodeClient::finish_transfer(const Progress& progress) {
  channel_.poll(pump_(*this));
  while (!channel_.idle()) {
    static_cast<void>(pump_(*this));
    if (progress) progress(channel_.transferred());
  }
  if (!channel_.failure().empty()) fail();
}

void NodeClient::fail() {
  const std::string text = channel_.failure();
  const canopen::AbortCode code = channel_.abort_code();
  const bool refused = channel_.refused();
  channel_.clear();
  if (refused) throw NodeRefused(text, code);
  if (!answered_) throw UserError(fmt::format("node {} does not answer", node_id_));
  if (code == canopen::AbortCode::timeout)
    throw UserError(fmt::format("{}; the node has stopped answering", text));
  throw UserError(text);
}

void NodeClient::let_pass(std::uint64_t time_us) {
  const std::uint64_t begin_us = pump_(*this);
  while (pump_(*this) - begin_us < time_us) {
  }
}

std::optional<NmtState> NodeClient::await_heartbeat(std::uint64_t timeout_us) {
  heartbeat_.reset();
  const std::uint64_t begin_us = pump_(*this);
  while (!heartbeat_ && pump_(*this) - begin_us < timeout_us) {
  }
  return heartbeat_;
}

void NodeClient::receive(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (frame.id == canopen::kHeartbeat + node_id_ && frame.size == 1)
    heartbeat_ = static_cast<NmtState>(frame.data[0] & 0x7FU);
  answered_ = answered_ || frame.id == canopen::kSdoResponse + node_id_;
  channel_.receive(frame, now_us);
}

std::uint64_t LinkPump::operator()(NodeClient& client) const {
  constexpr std::uint32_t kWait_us = 1000;
  canopen::exchange(client, *link_, link_->now_us());
  link_->wait(kWait_us);
  return link_->now_us();
}

}  // namespace volcomp::host
