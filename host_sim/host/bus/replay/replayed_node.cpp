#include "host_sim/host/bus/replay/replayed_node.hpp"

#include <algorithm>
#include <utility>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using node::StoreResult;

namespace {

// What a node asks of its surroundings: poll() at least every millisecond.
constexpr std::uint64_t kPoll_us = 1000;
// A gap in a log may be long, and nothing happens in most of it.
constexpr std::uint64_t kMostPolls = 10'000;

void fill(Span<std::uint8_t>& target, const std::vector<std::uint8_t>& source) {
  const std::size_t size = std::min(target.size(), source.size());
  std::copy_n(source.begin(), size, target.begin());
  target = {target.data(), size};
}

}  // namespace

bool is_boot_up(const hal::CanFrame& frame, std::uint8_t node_id) {
  return frame.id == canopen::kHeartbeat + node_id && frame.size == 1 && frame.data[0] == 0;
}

StoreResult ImageStorage::save(Span<const std::uint8_t> parameters,
                               Span<const std::uint8_t> image) {
  parameters_.assign(parameters.begin(), parameters.end());
  image_.assign(image.begin(), image.end());
  return StoreResult::done;
}

StoreResult ImageStorage::load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) {
  if (parameters_.empty() && image_.empty()) return StoreResult::nothing_stored;
  fill(parameters, parameters_);
  fill(image, image_);
  return StoreResult::loaded;
}

StoreResult ImageStorage::erase() {
  parameters_.clear();
  image_.clear();
  return StoreResult::done;
}

ReplayedNode::ReplayedNode(std::uint8_t node_id, std::vector<std::uint8_t> stored_image,
                           OnSent on_sent)
    : node_id_(node_id), storage_(std::move(stored_image)), on_sent_(std::move(on_sent)) {}

void ReplayedNode::power_on(std::uint64_t time_us) {
  time_us_ = time_us;
  node_ = std::make_unique<node::Node>(node_id_, &storage_);
  node_->power_on(time_us);
  poll(time_us);
}

void ReplayedNode::advance(std::uint64_t time_us) {
  const std::uint64_t pause = std::max(kPoll_us, (time_us - time_us_) / kMostPolls);
  while (true) {
    const std::uint64_t due = std::max(node_->deadline_us(), time_us_ + 1);
    const std::uint64_t next = std::min(due, time_us_ + pause);
    if (next >= time_us) break;
    time_us_ = next;
    poll(next);
  }
  time_us_ = time_us;
}

void ReplayedNode::receive(const hal::CanFrame& frame, std::uint64_t time_us) {
  node_->receive(frame, time_us);
  poll(time_us);
}

void ReplayedNode::poll(std::uint64_t time_us) {
  node_->poll(time_us);
  hal::CanFrame frame;
  while (node_->offer(frame, time_us)) {
    node_->taken(time_us);
    if (frame.id == canopen::kSync)
      throw UserError("the node produces SYNC itself; only a node that follows can be replayed");
    on_sent_(time_us, frame);
  }
}

bool ReplayedNode::sends(std::uint16_t id) const {
  if (id == canopen::kHeartbeat + node_id_ || id == canopen::kSdoResponse + node_id_ ||
      id == canopen::kEmergency + node_id_)
    return true;
  const Span<canopen::Pdo> pdos = node_->device().pdos().transmit();
  return std::any_of(pdos.begin(), pdos.end(),
                     [id](const canopen::Pdo& pdo) { return pdo.valid() && pdo.id() == id; });
}

const canopen::Pdo& ReplayedNode::status_pdo() const {
  return node_->device().pdos().transmit()[node::kStatusPdo];
}

bool ReplayedNode::is_status(std::uint16_t id) const {
  return status_pdo().valid() && status_pdo().id() == id;
}

hal::CanFrame ReplayedNode::status() const {
  hal::CanFrame frame;
  status_pdo().gather(frame);
  return frame;
}

bool ReplayedNode::status_every_cycle() const {
  return status_pdo().valid() && status_pdo().parameters().inhibit_100us == 0;
}

}  // namespace volcomp::host
