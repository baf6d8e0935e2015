#pragma once
// Who lives through a recorded past: a node in this process, or one behind a frame pipe.

#include <cstdint>
#include <functional>
#include <memory>

#include "hal/can_port.hpp"

namespace volcomp::host {

class ReplayedNode;

class ReplaySubject {
 public:
  // Called for every frame the node sends, at the log's time.
  using OnSent = std::function<void(std::uint64_t time_us, const hal::CanFrame& frame)>;

  ReplaySubject() = default;
  ReplaySubject(const ReplaySubject&) = delete;
  ReplaySubject& operator=(const ReplaySubject&) = delete;
  virtual ~ReplaySubject() = default;

  // A fresh start. Before everything else.
  virtual void power_on(std::uint64_t time_us) = 0;
  // Lets the time before this moment pass, deadlines kept to the microsecond. What happens at the
  // moment itself comes next: a frame of somebody else, or nothing but the time.
  virtual void advance(std::uint64_t time_us) = 0;
  virtual void receive(const hal::CanFrame& frame, std::uint64_t time_us) = 0;
  virtual void poll(std::uint64_t time_us) = 0;

  // Before the SYNC that ends a cycle: the node has heard all of it.
  virtual void end_cycle() {}
  // The log says that the node has spoken here, but it has not yet: gives it a little more time.
  // False where that does not help.
  virtual bool linger() { return false; }

  // A node in this process that has lived through the same: knows which frames are the node's.
  [[nodiscard]] virtual const ReplayedNode& model() const = 0;
};

// Makes a subject that reports to this function.
using MakeSubject = std::function<std::unique_ptr<ReplaySubject>(ReplaySubject::OnSent)>;

}  // namespace volcomp::host
