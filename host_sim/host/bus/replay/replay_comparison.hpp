#pragma once
// What a replayed node sends beside what the log says the first one sent; the rules are those of
// replay.hpp.

#include <deque>
#include <map>
#include <set>

#include "host_sim/host/bus/replay/replay.hpp"
#include "host_sim/host/bus/replay/replayed_node.hpp"

namespace volcomp::host {

class Comparison {
 public:
  // `make_subject`: who is to live through the log.
  Comparison(std::uint8_t node_id, const MakeSubject& make_subject);
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;
  ~Comparison() = default;

  // With the first frame to take: a boot-up of the node or a command to reset it.
  void start(const LoggedFrame& first);
  void take(const LoggedFrame& logged);
  // After the last frame.
  void finish();

  [[nodiscard]] const ReplayedNode& node() const { return subject_->model(); }
  [[nodiscard]] const ReplayResult& result() const { return result_; }

 private:
  // One frame of the node, from the log or from the replay.
  struct Said {
    hal::CanFrame frame{};
    std::uint64_t time_us = 0;
    std::uint64_t cycle = 0;
    std::uint8_t counter = 0;
    std::size_t line = 0;
  };

  // The frames of one identifier that wait for their counterpart. Only one side ever waits.
  struct Stream {
    std::deque<Said> logged;
    std::deque<Said> replayed;
  };

  void take_input(const LoggedFrame& logged);
  void take_answer(const LoggedFrame& logged);
  void take_boot_up(const LoggedFrame& logged);
  void await(std::uint16_t id);
  void compare_heartbeat(const Said& said);
  void compare_status(const Said& said);
  [[nodiscard]] bool take_start_status(const hal::CanFrame& frame);
  void replayed(std::uint64_t time_us, const hal::CanFrame& frame);
  void forget_unsent();
  void match(Stream& stream);
  void observe();
  void begin_cycle();
  void check_age();
  [[nodiscard]] bool process_data(std::uint16_t id) const;
  [[nodiscard]] bool in_this_process() const;
  [[nodiscard]] bool free_status(std::uint16_t id) const;
  [[nodiscard]] bool could_say(const hal::CanFrame& status) const;
  [[nodiscard]] std::string name_of(std::uint16_t id) const;
  [[nodiscard]] ReplayDifference difference(const Said& where, const char* what) const;
  void differs(const Said& expected, const hal::CanFrame& got, const char* what);
  void not_sent(const Said& expected);
  void not_logged(const Said& got);
  void had_power();

  std::uint8_t node_id_;
  std::map<std::uint16_t, Stream> streams_;
  std::unique_ptr<ReplaySubject> subject_;
  ReplayResult result_;
  std::optional<ReplayDifference> missing_;  // in the log: the first, since the last boot-up
  std::size_t compared_at_boot_up_ = 0;
  std::uint64_t now_us_ = 0;
  std::uint8_t counter_ = 0;

  bool cycle_begun_ = false;                   // a SYNC has come in this NMT state
  bool first_cycle_ = false;                   // and it was the first
  std::optional<hal::CanFrame> start_status_;  // said before; not yet found in the log
  std::set<std::uint8_t> states_;              // NMT, since the last heartbeat in the log
  std::vector<hal::CanFrame> status_;          // said in this cycle
  std::vector<hal::CanFrame> earlier_status_;  // and in the one before
  bool status_due_ = false;                    // the replayed node sent one in this cycle
  bool status_overdue_ = false;                // and one in the cycle before
};

}  // namespace volcomp::host
