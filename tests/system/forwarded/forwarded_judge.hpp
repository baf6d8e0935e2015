#pragma once
// Watches what the node hears and sends, and what each drive takes: the promises of
// firmware/node/forwarding.hpp, seen from outside.
//
//   - every target that the node sends is one that it has heard since, plus the offset that its
//     gate gives out (2020h), which is at most 2201h; none is sent twice or older than four cycles
//   - a drive that would take it for something else gets none
//   - from one target that a drive takes to the next: what the controller moved plus 2202h
//   - the same, and once at most 2201h: the controller told a drive to disable and to enable again,
//     every status in between was lost on its way to the node, and the drive has not heard the
//     first. The node presumes that it stopped, and begins anew with offset 0.
//   - the first target that a drive takes has no offset once the node knows that it did not follow

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/sim/drives/cia402_drive.hpp"

namespace volcomp::sim {

inline constexpr std::size_t kForwardedAxes = 3;

// A target of the controller as the node sent it.
struct SentTarget {
  std::int32_t target = 0;   // 607Ah of the controller
  std::int32_t sent = 0;     // 607Ah of the node
  std::uint64_t cycle = 0;   // in which it was sent
  std::uint64_t number = 0;  // of the targets that the node has sent to this axis
  [[nodiscard]] std::int64_t offset() const { return std::int64_t{sent} - target; }
};

// What a drive had at a SYNC, to compare with that of another bus.
struct DriveAtSync {
  std::uint64_t cycle = 0;
  std::uint16_t controlword = 0;
  std::optional<std::int32_t> target;  // of the controller, in the last that came since its start
};

class ForwardedJudge {
 public:
  ForwardedJudge(const node::Node& node, std::int64_t limit, std::int64_t slew)
      : node_(node), limit_(limit), slew_(slew) {}

  void begin_cycle(std::uint64_t cycle) { cycle_ = cycle; }
  // The controller has put a target on the bus.
  void said(const hal::CanFrame& frame);
  void node_hears(const hal::CanFrame& frame);
  void node_sends(const hal::CanFrame& frame);
  void node_restarts();
  void drive_boots(std::size_t axis);
  // Around Cia402Drive::receive().
  void before(std::size_t axis, const Cia402Drive& drive, Cia402Device& device,
              const hal::CanFrame& frame);
  void after(std::size_t axis, const Cia402Drive& drive, bool takes_at_once,
             const hal::CanFrame& frame);
  void input(std::size_t axis, std::int32_t target);
  // Frames to, from or by the node were hit in this cycle, and in so many more.
  void hit(std::uint64_t cycles_more);

  // Empty: nothing was wrong.
  [[nodiscard]] const std::string& violation() const { return violation_; }
  [[nodiscard]] std::uint64_t forwarded() const { return forwarded_; }
  [[nodiscard]] std::uint64_t taken() const { return taken_; }
  [[nodiscard]] std::uint64_t corrected() const { return corrected_; }
  [[nodiscard]] std::uint64_t switched_on() const { return switched_on_; }
  // Steps of drives that were presumed to have stopped.
  [[nodiscard]] std::uint64_t presumed() const { return presumed_; }
  // First targets that were under way when the node did not know yet.
  [[nodiscard]] std::uint64_t under_way() const { return under_way_; }
  [[nodiscard]] const std::vector<DriveAtSync>& history(std::size_t axis) const {
    return axis_.at(axis).history;
  }
  // Cycles in a row, up to this one, in which something of the node was hit.
  [[nodiscard]] std::uint64_t hits_until(std::uint64_t cycle) const;

 private:
  struct Axis {
    std::map<std::int32_t, std::uint64_t> said;  // targets of the controller: cycle of the last
    std::optional<std::int32_t> heard;           // by the node, not sent yet
    std::deque<SentTarget> under_way;            // sent lately
    std::optional<SentTarget> arrived;           // at the drive, since its last SYNC
    std::optional<SentTarget> last;              // at the drive
    std::optional<SentTarget> taken;             // since it follows
    std::optional<std::uint64_t> told;           // sent() when the node heard that it does not
    std::optional<std::int32_t> input;           // at this SYNC
    bool disabled_unseen = false;                // the node heard 6040h, and no 6041h since
    std::uint64_t presumed = 0;  // number of the first target after it was enabled so
    bool served = false;         // a target has come since the drive was started
    std::uint64_t sent = 0;
    std::uint64_t periods = 0;
    std::uint64_t booted = 0;  // cycle
    std::vector<DriveAtSync> history;
  };

  void wrong(std::size_t axis, const std::string& what);
  void take(std::size_t axis, const SentTarget& target);
  void at_sync(std::size_t axis, const Cia402Drive& drive);
  [[nodiscard]] std::optional<SentTarget> sent_target(std::size_t axis, std::int32_t value) const;

  const node::Node& node_;
  std::int64_t limit_;
  std::int64_t slew_;
  std::array<Axis, kForwardedAxes> axis_;
  std::vector<bool> hit_;  // by cycle
  std::string violation_;
  std::uint64_t cycle_ = 0;
  std::uint64_t forwarded_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t corrected_ = 0;
  std::uint64_t switched_on_ = 0;
  std::uint64_t under_way_ = 0;
  std::uint64_t presumed_ = 0;
};

}  // namespace volcomp::sim
