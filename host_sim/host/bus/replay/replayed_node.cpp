#include "host_sim/host/bus/replay/replayed_node.hpp"

#include <algorithm>
#include <utility>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/object_handles.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::Pdo;
using node::StoreResult;

namespace {

// A node needs a poll() at least every millisecond.
constexpr std::uint64_t kPoll_us = 1000;
// A gap in a log may be long, and nothing happens in most of it.
constexpr std::uint64_t kMostPolls = 10'000;

void fill(Span<std::uint8_t>& target, const std::vector<std::uint8_t>& source) {
  const std::size_t size = std::min(target.size(), source.size());
  std::copy_n(source.begin(), size, target.begin());
  target = {target.data(), size};
}

bool is_timed_pdo(const Pdo& pdo, std::size_t number) {
  const canopen::PdoParameters& p = pdo.parameters();
  return number == node::kStatusPdo ||
         (!pdo.synchronous() && (p.inhibit_100us != 0 || p.event_timer_ms != 0));
}

// The number of the PDO with this identifier; what the span has not: none.
std::size_t find_pdo(Span<Pdo> pdos, std::uint16_t id) {
  return static_cast<std::size_t>(
      std::find_if(pdos.begin(), pdos.end(), [id](const Pdo& p) { return p.answers_to(id); }) -
      pdos.begin());
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
  now_us_ = time_us;
  node_ = std::make_unique<node::Node>(node_id_, &storage_);
  node_->power_on(time_us);
  poll();
}

void ReplayedNode::receive(const hal::CanFrame& frame, std::uint64_t time_us) {
  advance(time_us);
  node_->device().receive(frame, now_us_);
  poll();
}

void ReplayedNode::pass_deadline() {
  if (!cycle_open()) return;
  now_us_ = std::max(now_us_, node_->deadline_us());
  poll();
}

// While a cycle is open, the node's clock stands before the deadline.
void ReplayedNode::advance(std::uint64_t time_us) {
  if (time_us <= now_us_) return;
  const std::uint64_t step = std::max(kPoll_us, (time_us - now_us_) / kMostPolls);
  while (now_us_ + step < time_us && now_us_ + step < node_->deadline_us()) {
    now_us_ += step;
    poll();
  }
  now_us_ = std::max(now_us_, std::min(time_us, node_->deadline_us() - 1));
}

void ReplayedNode::poll() {
  node_->device().poll(now_us_);
  hal::CanFrame frame;
  while (node_->device().offer(frame, now_us_)) {
    node_->device().taken(now_us_);
    if (frame.id == canopen::kSync)
      throw UserError("the node produces SYNC itself; only a node that follows can be replayed");
    on_sent_(frame);
  }
}

bool ReplayedNode::sends(std::uint16_t id) const {
  const Span<Pdo> pdos = node_->device().pdos().transmit();
  return id == canopen::kHeartbeat + node_id_ || id == canopen::kSdoResponse + node_id_ ||
         id == canopen::kEmergency + node_id_ || find_pdo(pdos, id) < pdos.size();
}

bool ReplayedNode::is_offset(std::uint16_t id) const {
  const Span<Pdo> pdos = node_->device().pdos().transmit();
  const std::size_t number = find_pdo(pdos, id);
  return number < node::kStatusPdo && !pdos[number].synchronous();
}

bool ReplayedNode::is_timed(std::uint16_t id) const {
  const Span<Pdo> pdos = node_->device().pdos().transmit();
  const std::size_t number = find_pdo(pdos, id);
  return number < pdos.size() && is_timed_pdo(pdos[number], number);
}

bool ReplayedNode::is_status(std::uint16_t id) const {
  return node_->device().pdos().transmit()[node::kStatusPdo].answers_to(id);
}

bool ReplayedNode::awaits(std::uint16_t id) const {
  const Span<Pdo> pdos = node_->device().pdos().receive();
  const std::size_t number = find_pdo(pdos, id);
  if (number == pdos.size()) return false;
  const canopen::PdoParameters& p = pdos[number].parameters();
  return std::any_of(p.mapping.begin(), p.mapping.begin() + p.count, [](std::uint32_t mapping) {
    const std::uint16_t index = canopen::object_of(mapping).index;
    return index == node::object::target.index || index == node::object::drive_status.index ||
           index == node::object::held_offset.index;
  });
}

std::vector<hal::CanFrame> ReplayedNode::timed() const {
  std::vector<hal::CanFrame> frames;
  const Span<Pdo> pdos = node_->device().pdos().transmit();
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    if (!pdos[i].valid() || !is_timed_pdo(pdos[i], i)) continue;
    frames.emplace_back();
    pdos[i].gather(frames.back());
  }
  return frames;
}

}  // namespace volcomp::host
