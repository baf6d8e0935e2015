#pragma once
// SYNC (CiA 301, section 7.2.5) as a consumer that keeps the count, or as the producer.

#include <cstdint>

#include "firmware/canopen/communication_objects.hpp"
#include "hal/can_port.hpp"

namespace volcomp::canopen {

enum class SyncVerdict : std::uint8_t {
  good,
  wrong_length,  // with or without counter against 1019h: not a SYNC of this network
  foreign,       // its counter does not continue the sequence: a second producer, not a cycle
};

class Sync {
 public:
  explicit Sync(CommunicationObjects& objects) : objects_(objects) {}

  // Judges a received SYNC. Up to kMostMissed messages of a sequence may be missing. After
  // kRestart refusals that count on among themselves the new sequence is accepted: the producer was
  // restarted.
  SyncVerdict received(const hal::CanFrame& frame);

  [[nodiscard]] bool producing() const { return (objects_.sync_cob_id & kProduce) != 0; }
  void stop_producing() { objects_.sync_cob_id &= ~kProduce; }
  // As producer: whether a SYNC is due; it is then the next frame to send.
  bool due(std::uint64_t now_us, hal::CanFrame& frame);

  void reset();

  // Of the last good one; without counter on the bus one of our own, 1…240.
  [[nodiscard]] std::uint8_t counter() const { return counter_; }
  [[nodiscard]] std::uint16_t id() const {
    return static_cast<std::uint16_t>(objects_.sync_cob_id & hal::kMaxCanId);
  }
  [[nodiscard]] std::uint32_t missed() const { return missed_; }
  [[nodiscard]] std::uint32_t foreign() const { return foreign_; }

  static constexpr std::uint32_t kProduce = 1U << 30U;  // 1005h

 private:
  static constexpr std::uint8_t kMostCount = 240;
  static constexpr std::uint8_t kMostMissed = 3;
  static constexpr std::uint8_t kRestart = 3;
  [[nodiscard]] std::uint8_t steps(std::uint8_t from, std::uint8_t to) const;

  CommunicationObjects& objects_;
  std::uint64_t next_us_ = 0;
  std::uint32_t missed_ = 0;
  std::uint32_t foreign_ = 0;
  std::uint8_t counter_ = 0;
  std::uint8_t refused_counter_ = 0;
  std::uint8_t refused_in_sequence_ = 0;
  bool started_ = false;
  bool producer_started_ = false;
};

}  // namespace volcomp::canopen
