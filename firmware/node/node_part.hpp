#pragma once
// The contract of the parts of a node (node.hpp). A part derives from NodePart and hides the
// members it does something for; all are bound at compile time.

#include "comp/core/span.hpp"
#include "firmware/canopen/object_access.hpp"

namespace volcomp::node {

struct NodePart {
  // Everything is as after power-on. Before the stored values are loaded.
  void reset() {}
  // The NMT state has changed, and the settings are those of the objects.
  void restart(bool /*operational*/) {}
  // These process data have arrived (arrivals.hpp). Tick.
  void arrived(std::uint32_t /*bits*/) {}
  // May take long; the tick may come in between, inside Preemptible scopes.
  void background(std::uint64_t /*now_us*/) {}
  // Before this time there is nothing to do in background() or, for the cycle, in due(), unless
  // another function is called.
  static std::uint64_t rests_until_us() { return UINT64_MAX; }

  // Refuses a value, or does what it commands.
  static canopen::AbortCode before_write(canopen::ObjectId /*object*/,
                                         Span<const std::uint8_t> /*bytes*/) {
    return canopen::AbortCode::none;
  }
  void written(canopen::ObjectId /*object*/) {}
  // Makes values that exist only when they are read.
  void before_read(canopen::ObjectId /*object*/) {}

  // The DOMAIN objects of the part; the others are called only for these.
  static bool owns_domain(canopen::ObjectId /*object*/) { return false; }
  static canopen::AbortCode read_domain(canopen::ObjectId /*object*/,
                                        Span<const std::uint8_t>& /*source*/) {
    return canopen::AbortCode::no_data;
  }
  static canopen::AbortCode begin_domain(std::size_t /*announced*/, Span<std::uint8_t>& /*sink*/) {
    return canopen::AbortCode::unsupported_access;
  }
  static canopen::AbortCode finish_domain(std::size_t /*size*/) { return canopen::AbortCode::none; }
  void abandon_domain() {}
};

}  // namespace volcomp::node
