#pragma once
// A node whose background is interrupted after single machine instructions (single_step.hpp), and
// the node in one context that receives the same: what they send can be compared turn by turn.

#include <cstdlib>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "tests/firmware/node/single_step.hpp"
#include "tests/firmware/node/task_bench.hpp"

namespace volcomp::node {

// First instructions of each scope of long work in which the interrupt is let in, unless all are
// requested.
constexpr std::uint64_t kFirstSteps = 1500;

inline std::uint64_t most_steps() {
  return std::getenv("VOLCOMP_TEST_ALL_STEPS") == nullptr ? kFirstSteps : UINT64_MAX;
}

// A frame the background had finished, and when it began with it.
struct Served {
  hal::CanFrame frame;
  std::uint64_t us = 0;
};

struct Turn {
  std::uint64_t us = 0;
  bool resetting = false;      // the node was in the middle of it
  std::vector<Served> served;  // since the turn before
  TaskBench::Frames in;
  TaskBench::Frames out;
};

// A task bench that writes down everything, with a background that can be interrupted anywhere.
class PreemptedBench {
 public:
  explicit PreemptedBench(Storage* storage = nullptr) : bench(storage) {
    bench.on_interrupt = [this](const TaskBench::Frames& in, const TaskBench::Frames& out) {
      note(in, out);
    };
    bench.background = [this] {
      while (step()) {
      }
    };
    bench.section.on_leave = [this] { leave(); };
    bench.section.on_enter = [this] { enter(); };
  }

  // From here on the interrupt comes as often as it can.
  void preempt(bool on) {
    preempted_ = on;
    bench.turn_us = on ? 10 : TaskBench::kTurn_us;
  }

  TaskBench bench;
  std::vector<Turn> turns;
  std::uint64_t interruptions = 0;
  std::function<void()> on_long_work;  // when the interrupt is let in

 private:
  void note(const TaskBench::Frames& in, const TaskBench::Frames& out) {
    const bool resetting = bench.task->node().device().state() == canopen::NmtState::boot_up;
    turns.push_back({bench.clock.us, resetting, std::move(served_), in, out});
    served_ = {};
    for (const hal::CanFrame& f : in) {
      if (bench.task->node().device().work(f) == NodeDevice::Work::lengthy) waiting_.push_back({f});
    }
  }

  void interrupt() {
    ++interruptions;
    bench.interrupt();
  }

  bool step() {
    serving_ = !waiting_.empty();
    if (!preempted_) return bench.task->background_step();
    bool more = false;
    test::SingleStep::through([&] { more = bench.task->background_step(); },
                              [&](std::uint64_t /*done*/) {
                                if (!bench.section.inside) interrupt();
                                return ++steps_ < most_steps_;
                              });
    return more;
  }

  // The background keeps the interrupt out: before it reads the clock and begins with a frame, or
  // at the end of long work.
  void enter() {
    if (preempted_) test::SingleStep::pause();
    if (serving_ && !bench.task->guardian().long_work()) waiting_.front().us = bench.clock.us;
  }

  // The background lets the interrupt in: with a frame that is finished, or in the middle of it.
  void leave() {
    if (serving_ && !bench.task->guardian().long_work()) {
      serving_ = false;
      served_.push_back(waiting_.front());
      waiting_.pop_front();
    }
    if (!preempted_) return;
    if (on_long_work && bench.task->guardian().long_work()) on_long_work();
    interrupt();
    steps_ = 0;
    test::SingleStep::resume();
  }

  bool preempted_ = false;
  bool serving_ = false;
  std::uint64_t most_steps_ = most_steps();
  std::uint64_t steps_ = 0;  // since the interrupt was let in
  std::deque<Served> waiting_;
  std::vector<Served> served_;
};

class SingleNode {
 public:
  explicit SingleNode(Storage* storage = nullptr)
      : node_(std::make_unique<Node>(NodeBench::kId, storage)) {
    node_->power_on(0);
  }

  // What it sends in such a turn.
  TaskBench::Frames turn(const Turn& turn) {
    for (const Served& s : turn.served)
      node_->device().receive(s.frame, s.us);
    for (const hal::CanFrame& f : turn.in) {
      if (node_->device().work(f) != NodeDevice::Work::lengthy) node_->device().receive(f, turn.us);
    }
    node_->device().poll(turn.us);
    TaskBench::Frames out;
    hal::CanFrame frame;
    while (out.size() < 32 && node_->device().offer(frame, turn.us)) {
      out.push_back(frame);
      node_->device().taken(turn.us);
    }
    return out;
  }

 private:
  std::unique_ptr<Node> node_;
};

// The node in one context sends the same in every turn. One that is being reset is not on the bus:
// it sends nothing, and what it did not receive is withheld from the other one, too.
inline void expect_same_in_one_context(const std::vector<Turn>& turns, Storage* storage = nullptr) {
  SingleNode single(storage);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i].resetting) {
      ASSERT_TRUE(turns[i].served.empty());
      ASSERT_TRUE(turns[i].out.empty()) << "turn " << i;
      continue;
    }
    ASSERT_EQ(turns[i].out, single.turn(turns[i])) << "turn " << i;
  }
}

}  // namespace volcomp::node
