#pragma once
// Compares the frames of a replayed node with those of the first one in the log, by the rules of
// replay.hpp. Waits for a slower node's answer before comparing.

#include <deque>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "host_sim/host/bus/replay/replay.hpp"

namespace volcomp::host {

// Makes the node into which the log is replayed; it reports to this function.
using MakeNode = std::function<std::unique_ptr<ReplayedNode>(ReplayedNode::OnSent)>;

class Comparison {
 public:
  Comparison(std::uint8_t node_id, const MakeNode& make_node);
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;
  ~Comparison() = default;

  // With the first frame to take: a boot-up of the node or a command to reset it.
  void start(const LoggedFrame& first);
  // `beside_sync`: the frame stands next to a SYNC and may belong to the cycle on its other side.
  void take(const LoggedFrame& logged, bool beside_sync);
  // After the last frame.
  void finish();

  [[nodiscard]] const ReplayResult& result() const { return result_; }

 private:
  // One frame of the node, from the log or from the replay.
  struct Said {
    hal::CanFrame frame{};
    ReplayPlace place{};
    bool beside_sync = false;
    bool may_be_lost = false;  // the node was reset before it can be sure to have left
  };
  // The frames of one identifier that wait for their counterpart. Only one side ever waits.
  struct Stream {
    std::deque<Said> logged;
    std::deque<Said> replayed;
  };

  void take_input(const LoggedFrame& logged);
  void take_answer(const LoggedFrame& logged, bool beside_sync);
  void take_boot_up(const LoggedFrame& logged);
  void replayed(const hal::CanFrame& frame);
  void match(Stream& stream);
  void begin_cycle(const hal::CanFrame& sync);
  void look_for_gaps(const hal::CanFrame& sync);
  void end_cycle();
  void observe_timed();
  void look_at_tables(const hal::CanFrame& status);
  void take_timed(const Said& said);
  void judge_unmatched();
  void judge_timed();
  void differs(const Said& where, const std::string& what,
               const std::optional<hal::CanFrame>& expected,
               const std::optional<hal::CanFrame>& got);
  void not_sent(const Said& said) { differs(said, "is not sent", said.frame, std::nullopt); }
  void not_logged(const Said& said) {
    differs(said, "is not in the log", std::nullopt, said.frame);
  }
  void lacks(const std::string& what, std::uint64_t until_cycle);

  std::uint8_t node_id_;
  std::unique_ptr<ReplayedNode> node_;
  ReplayResult result_;
  ReplayPlace now_{};
  std::map<std::uint16_t, Stream> streams_;
  std::uint64_t last_cycle_ = 0;  // in which the log has a frame of the node
  std::size_t boot_ups_ = 0;      // of the replayed node that the log has not yet
  bool status_seen_ = false;      // in the log
  bool fresh_ = true;             // nothing has been compared since the last boot-up
  std::size_t offset_line_ = 0;   // in the log, of the first offset of the open cycle

  std::set<std::uint16_t> heard_;          // in this cycle, of what a cycle waits for
  std::set<std::uint16_t> heard_earlier_;  // in the one before
  std::uint64_t lacks_until_cycle_ = 0;

  // Of both nodes, with what the node in this process had to send at that time.
  std::vector<std::pair<Said, std::optional<hal::CanFrame>>> timed_;
  std::set<std::pair<std::uint16_t, std::vector<std::uint8_t>>> true_once_;
};

}  // namespace volcomp::host
