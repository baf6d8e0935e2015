#pragma once
// The strokes of a helical grinder (201Ah, 2500h): process data in, learned offsets to C, learning
// on command.

#include <type_traits>

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/strokes/stroke_service.hpp"

namespace volcomp::node {

class WatchedStrokes : public NodePart {
 public:
  explicit WatchedStrokes(NodeCore& core);

  void reset() { service_.switch_off(); }
  void restart(bool operational);
  void background(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t rests_until_us() const { return service_.on() ? 0 : UINT64_MAX; }
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes);
  void before_read(canopen::ObjectId object);
  static bool owns_domain(canopen::ObjectId object) {
    return object.index >= object::stroke::command.index && object.index < object::state.index;
  }
  canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source);
  canopen::AbortCode begin_domain(std::size_t announced, Span<std::uint8_t>& sink);
  canopen::AbortCode finish_domain(std::size_t size);

  // --- tick

  // What C gets in addition, 2^-32 turn.
  std::int32_t tick();
  [[nodiscard]] bool learns_for(std::size_t axis) const;
  // Before the first tick in which offsets go out: what the drives hold.
  void start(const PerAxis<std::int32_t>& held);
  // The offset of C, of the tables of the machine and of the learned ones together, in the limits
  // of the axis: a sum of offsets need not keep the acceleration that each of them keeps.
  std::int32_t add(std::int32_t offset, std::int32_t learned);
  // The offset goes to 0 at once.
  void stop() { service_.stop(); }

  // --- store

  // The learned tables; empty while nothing has been learned.
  [[nodiscard]] Span<const std::uint8_t> learned_image();
  // A piece of stored tables that begins at `size`, which grows by it.
  void load_learned(Span<const std::uint8_t> piece, std::size_t& size);
  // All settings and `learned_size` bytes of tables have been loaded.
  void finish_loading(std::size_t learned_size);

 private:
  [[nodiscard]] StrokeAxisReport axis_report(std::size_t axis) const;
  void show_limited(bool clamped, bool held_back);
  bool report(const Status& status);
  canopen::AbortCode switch_to(StrokeCommand command);
  canopen::AbortCode learn(LearnCommand command);
  [[nodiscard]] std::uint32_t period_us() const {
    return core_.objects.communication.cycle_period_us;
  }

  NodeCore& core_;
  StrokeService service_;
  OffsetLimits limits_{};           // of C
  OffsetLimiter<true> sum_;         // where they bound the acceleration
  std::uint32_t syncs_missed_ = 0;  // when the last cycle was computed
};

// A node that does not watch strokes.
struct NoStrokes : NodePart {
  explicit NoStrokes(NodeCore& /*core*/) {}
  static std::int32_t tick() { return 0; }
  static bool learns_for(std::size_t /*axis*/) { return false; }
  void start(const PerAxis<std::int32_t>& /*held*/) {}
  static std::int32_t add(std::int32_t offset, std::int32_t /*learned*/) { return offset; }
  void stop() {}
  static Span<const std::uint8_t> learned_image() { return {}; }
  void load_learned(Span<const std::uint8_t> /*piece*/, std::size_t& /*size*/) {}
  void finish_loading(std::size_t /*learned_size*/) {}
};

using StrokePart = std::conditional_t<kWatchesStrokes, WatchedStrokes, NoStrokes>;

}  // namespace volcomp::node
