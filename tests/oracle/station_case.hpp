#pragma once
// The gate of a node as the last check before a drive: bounds as used, no reports, nothing late.

#include "firmware/node/offset_gate.hpp"

namespace volcomp::test {

class StationCase {
 public:
  StationCase(const OffsetLimits& limits, std::int32_t held) {
    const OffsetBounds used(limits);
    node::GateBounds bounds;
    bounds.limit = used.limit;
    bounds.slew = node::kMostHeld;
    bounds.soft = used.soft_rate;
    bounds.rate = used.rate;
    bounds.acceleration = used.acceleration;
    bounds.late = 0;
    bounds.reports = 0;
    gate_.configure(bounds);
    gate_.start_at(held);
    gate_.join();
  }
  // What is sent.
  std::int32_t pass(std::int32_t wanted) {
    std::int32_t value = 0;
    gate_.begin_cycle();
    if (gate_.next(wanted, value)) gate_.handed_over(value);
    return value;
  }
  [[nodiscard]] bool tripped() const { return gate_.refused(); }

 private:
  node::OffsetGate gate_;
};

}  // namespace volcomp::test
