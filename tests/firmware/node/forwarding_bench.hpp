#pragma once
// Drives that take their target from the node (way 1), and their controller, one bus cycle at a
// time. Every frame may be lost, doubled or late; the node may stand still, be killed and come
// back. What a drive takes at SYNC is judged at once: the promises of firmware/node/forwarding.hpp.

#include <deque>
#include <optional>

#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {

// A target as the controller meant it, and as the node sent it.
struct ForwardedTarget {
  std::int32_t target = 0;  // 607Ah of the controller
  std::int32_t sent = 0;    // 607Ah of the node
  [[nodiscard]] std::int32_t offset() const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(sent) -
                                     static_cast<std::uint32_t>(target));
  }
};

struct FollowingDrive {
  bool enabled = false;
  bool referenced = true;
  bool unmoved = false;                  // takes 607Ah from elsewhere, as the controller means it
  std::int8_t mode = 8;                  // 6061h
  std::int32_t target = 0;               // that the controller sends next
  std::int32_t actual = 0;               // 6064h: it stands where it was told, at the next SYNC
  std::optional<ForwardedTarget> waits;  // has come, acts at SYNC
  std::optional<ForwardedTarget> taken;  // since it follows
  [[nodiscard]] bool follows() const { return enabled && mode == 8; }
};

// What may happen to a frame.
struct FrameFaults {
  double lost = 0.0;
  double doubled = 0.0;
  double late = 0.0;  // by a cycle or two
};

class ForwardingBench {
 public:
  static constexpr std::size_t kDrives = NodeBench::kDrives;
  static constexpr std::int32_t kLimit = 200'000;

  explicit ForwardingBench(std::uint64_t seed = 1) : random_(seed) {}

  // All axes of way 1, tables loaded, started; drives mapped, nobody enabled.
  void bring_up();
  void configure();
  // 2037h, as the controller writes it when it has read the mapping back.
  void confirm_mapping();
  void start() { bench.nmt(canopen::NmtCommand::start); }
  // The controller sends 6064h as target and enables, or disables.
  void enable(bool on);
  void home(bool homing);

  // A drive boots: it has its default mapping again.
  void boot(std::size_t axis);
  // A SYNC of somebody else: the drives take what they have.
  void foreign_sync();
  // SYNC, status, targets, deadline.
  void cycle();
  void cycles(int count);
  void move(std::int32_t by);  // every target

  // While true, nothing reaches the node and it does nothing.
  void stall(bool stalled);
  // Power off and on; it is configured and started anew, while drives and controller go on.
  void restart_node();

  [[nodiscard]] bool heartbeat_seen() const { return heartbeats_ > 0; }
  void forget_heartbeats() { heartbeats_ = 0; }
  // Frames to drives in the last cycle.
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] test::Random& random() { return random_; }
  [[nodiscard]] bool bit15() { return (bench.number(0x2600, 3) & 0x8000U) != 0; }

  NodeBench bench;
  std::array<FollowingDrive, kDrives> drive;
  FrameFaults faults;
  std::int32_t slew = 20'000;      // 2202h
  std::int32_t soft_rate = 1'000;  // 2203h
  // Whether anything may be sent to this drive now; what is, is a fault.
  std::array<bool, kDrives> mapped{true, true, true};
  bool controller_speaks = true;
  bool drives_speak = true;
  bool sync_speaks = true;
  bool counts_sync = true;  // 1019h

 private:
  void give(const hal::CanFrame& frame);
  void status(std::size_t axis);
  void target(std::size_t axis);
  void collect();
  void deliver(std::size_t axis, const ForwardedTarget& target);
  void take(FollowingDrive& d);
  void take_all();
  hal::CanFrame sync_frame(std::uint8_t counter) const;
  void hear_now(const hal::CanFrame& frame, std::uint64_t sent);
  void pass_late();

  struct LateFrame {
    int cycles;
    hal::CanFrame frame;
    std::uint64_t sent;  // cycle
  };
  struct HeldFrame {
    hal::CanFrame frame;
    std::uint64_t sent;
  };
  struct LateTarget {
    int cycles;
    std::size_t axis;
    ForwardedTarget target;
  };
  test::Random random_;
  std::deque<HeldFrame> held_;  // for a node that stands still
  std::vector<LateFrame> late_in_;
  std::vector<LateTarget> late_out_;
  struct Heard {
    std::int32_t target;
    std::uint64_t cycle;
  };
  std::array<std::optional<Heard>, kDrives> heard_;  // not yet forwarded
  std::uint64_t cycle_ = 0;
  std::uint8_t counter_ = 0;
  int heartbeats_ = 0;
  int frames_ = 0;
  bool stalled_ = false;
};

}  // namespace volcomp::node
