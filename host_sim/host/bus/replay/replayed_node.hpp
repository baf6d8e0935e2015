#pragma once
// A node that lives through a recorded past: it receives what the log says the bus carried, and the
// log's clock is its time.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/host/bus/replay/replay_subject.hpp"

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

class ReplayedNode final : public ReplaySubject {
 public:
  // `stored_image`: tables the node finds at power-on, empty for none.
  ReplayedNode(std::uint8_t node_id, std::vector<std::uint8_t> stored_image, OnSent on_sent);

  void power_on(std::uint64_t time_us) override;
  void advance(std::uint64_t time_us) override;
  void receive(const hal::CanFrame& frame, std::uint64_t time_us) override;
  void poll(std::uint64_t time_us) override;
  [[nodiscard]] const ReplayedNode& model() const override { return *this; }

  // Whether the node is the one that sends frames with this identifier, as configured now.
  [[nodiscard]] bool sends(std::uint16_t id) const;
  [[nodiscard]] bool is_status(std::uint16_t id) const;
  // What its status PDO says now, and whether that leaves in every cycle.
  [[nodiscard]] hal::CanFrame status() const;
  [[nodiscard]] bool status_every_cycle() const;
  [[nodiscard]] canopen::NmtState state() const { return node_->device().state(); }
  // When its next deadline is; UINT64_MAX: there is none.
  [[nodiscard]] std::uint64_t deadline_us() const { return node_->deadline_us(); }
  [[nodiscard]] std::uint32_t active_crc() const { return node_->objects().active_crc; }

 private:
  [[nodiscard]] const canopen::Pdo& status_pdo() const;

  std::uint8_t node_id_;
  ImageStorage storage_;
  OnSent on_sent_;
  std::unique_ptr<node::Node> node_;
  std::uint64_t time_us_ = 0;
};

}  // namespace volcomp::host
