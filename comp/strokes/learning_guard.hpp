#pragma once
// Stops a learning table that gets worse: J is what the flank shows, RMS in µm, before each update.

#include <cmath>
#include <cstdint>
#include <limits>

#include "comp/strokes/learning.hpp"

namespace volcomp {

enum class GuardAction : std::uint8_t {
  keep,       // go on learning
  hold,       // J rose by more than 5 % once: the best table stays in reserve
  roll_back,  // twice in a row, or J is not finite: back to the best table
};

class LearningGuard {
 public:
  GuardAction judge(double J) {
    constexpr double kRise = 1.05;
    if (!std::isfinite(J)) {
      rises_ = 0;
      return GuardAction::roll_back;
    }
    const bool up = J > kRise * previous_;
    previous_ = J;
    rises_ = up ? rises_ + 1 : 0;
    if (J < best_) best_ = J;
    if (rises_ == 2) {
      rises_ = 0;
      previous_ = best_;
      return GuardAction::roll_back;
    }
    return up ? GuardAction::hold : GuardAction::keep;
  }

  // The least J so far; infinite before the first.
  [[nodiscard]] double best() const { return best_; }

 private:
  double previous_ = std::numeric_limits<double>::infinity();
  double best_ = std::numeric_limits<double>::infinity();
  int rises_ = 0;
};

struct LearnerStep {
  GuardAction action = GuardAction::keep;
  LearningReport report{};  // of the update, where there was one
};

// A table under its guard: what it holds, the best it has held, and the weight, halved by every
// roll-back that J caused. Learning goes on after the first rise: a table that stands still cannot
// rise a second time, so a diverging weight would never be distinguished from a bad pass.
// Background only.
template <std::size_t Nodes>
class OffsetLearner {
 public:
  // All offsets 0. Refuses what check_rules() refuses, too_few_knots, too_many_knots (count).
  Status start(const LearningRules& rules, std::size_t nodes) {
    Where where;
    where.count = static_cast<int>(nodes);
    if (nodes < 1) return refuse(Reason::too_few_knots, where);
    if (nodes > Nodes) return refuse(Reason::too_many_knots, where);
    if (const Status s = check_rules(rules); !s.ok()) return s;
    rules_ = rules;
    guard_ = {};
    nodes_ = nodes;
    table_.fill(0.0);
    best_.fill(0.0);
    return {};
  }

  // One pass: `J` is the RMS on the flank (µm) with the table as it is, `sums` what the monitor
  // saw. `sums.size()` must be size(). Without data, as when the machine ground in the other
  // direction only, nothing is judged and nothing changes: nodata.
  LearnerStep step(double J, Span<const NodeSums> sums) {
    LearnerStep step;
    if (!any_node_valid(rules_, sums)) {
      step.report.result = LearningResult::nodata;
      return step;
    }
    const double best = guard_.best();
    step.action = guard_.judge(J);
    if (step.action == GuardAction::roll_back) {
      if (std::isfinite(J)) rules_.weight *= 0.5;
      table_ = best_;
      return step;
    }
    if (J < best) best_ = table_;
    step.report =
        learning_update(rules_, sums, {table_.data(), nodes_}, {smoothed_.data(), nodes_});
    return step;
  }

  // A table that was learned earlier: `value_of(node)`. The guard starts anew.
  template <class ValueOf>
  void load(const ValueOf& value_of) {
    guard_ = {};
    for (std::size_t j = 0; j < nodes_; ++j)
      table_[j] = best_[j] = value_of(j);
  }

  [[nodiscard]] Span<const double> table() const { return {table_.data(), nodes_}; }
  [[nodiscard]] std::size_t size() const { return nodes_; }
  [[nodiscard]] const LearningRules& rules() const { return rules_; }

 private:
  LearningRules rules_{};
  LearningGuard guard_{};
  std::size_t nodes_ = 0;
  std::array<double, Nodes> table_{};
  std::array<double, Nodes> best_{};
  std::array<double, Nodes> smoothed_{};
};

}  // namespace volcomp
