#pragma once
// The node a log is replayed into: it receives the frames of the log, and the log's clock is its
// time. Only the deadline of a cycle (2200h:03) does not pass by itself: the frames of the first
// node show when it passed, because the log's clock may have been set.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "firmware/node/node.hpp"

namespace volcomp::host {

[[nodiscard]] bool is_boot_up(const hal::CanFrame& frame, std::uint8_t node_id);

// What a node finds at power-on: parameters at their defaults and these tables, until it saves
// something else itself.
class ImageStorage final : public node::Storage {
 public:
  explicit ImageStorage(std::vector<std::uint8_t> image) : image_(std::move(image)) {}

  node::StoreResult save(Span<const std::uint8_t> parameters,
                         Span<const std::uint8_t> image) override;
  node::StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override;
  node::StoreResult erase() override;

 private:
  std::vector<std::uint8_t> parameters_;
  std::vector<std::uint8_t> image_;
};

class ReplayedNode {
 public:
  using OnSent = std::function<void(const hal::CanFrame& frame)>;

  // `stored_image`: tables the node finds at power-on, empty for none.
  ReplayedNode(std::uint8_t node_id, std::vector<std::uint8_t> stored_image, OnSent on_sent);
  ReplayedNode(const ReplayedNode&) = delete;
  ReplayedNode& operator=(const ReplayedNode&) = delete;
  virtual ~ReplayedNode() = default;

  // A fresh start. Before everything else.
  virtual void power_on(std::uint64_t time_us);
  virtual void receive(const hal::CanFrame& frame, std::uint64_t time_us);
  // Ends the open cycle, if there is one: nothing more of it is awaited.
  virtual void pass_deadline();

  [[nodiscard]] bool cycle_open() const { return node_->deadline_us() != UINT64_MAX; }
  // Whether the node is the one that sends frames with this identifier, as configured now; whether
  // these are offsets that leave as soon as they are computed; whether only its clock decides when
  // they leave: the status PDO, and what has an inhibit time or an event timer.
  [[nodiscard]] bool sends(std::uint16_t id) const;
  [[nodiscard]] bool is_offset(std::uint16_t id) const;
  [[nodiscard]] bool is_timed(std::uint16_t id) const;
  [[nodiscard]] bool is_status(std::uint16_t id) const;
  // Whether a cycle waits for this frame of others.
  [[nodiscard]] bool awaits(std::uint16_t id) const;
  // The present content of the timed process data.
  [[nodiscard]] std::vector<hal::CanFrame> timed() const;
  [[nodiscard]] std::uint32_t active_crc() const { return node_->objects().active_crc; }

 protected:
  // The node's own clock.
  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }

 private:
  void advance(std::uint64_t time_us);
  void poll();

  std::uint8_t node_id_;
  ImageStorage storage_;
  OnSent on_sent_;
  std::unique_ptr<node::Node> node_;
  std::uint64_t now_us_ = 0;
};

}  // namespace volcomp::host
