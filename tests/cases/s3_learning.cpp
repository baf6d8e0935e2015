// Cases of docs/papers/internal-helical.md: learning of offset tables, their guard, and the
// statistics it is fed with.

#include <cmath>

#include "comp/machine/fine_trig.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "comp/strokes/spectral_line.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"

namespace volcomp::cases {
namespace {

LearningRules rules_of(const json& in) {
  LearningRules rules;
  rules.weight = number(in.at("w"));
  rules.periodic = in.at("periodic").get<bool>();
  rules.least_samples = in.at("n_min").get<std::uint32_t>();
  rules.dead_sigma = number(in.at("dead_sigma"));
  rules.most_step = number(in.at("step_max"));
  rules.most_offset = number(in.at("t_max"));
  rules.most_slope = number(in.at("slope_max"));
  rules.spacing = number(in.at("h"));
  const std::vector<double> taps = numbers(in.at("taps"));
  rules.tap_count = taps.size();
  for (std::size_t k = 0; k < taps.size(); ++k)
    rules.taps.at(k) = taps[k];
  require(check_rules(rules));
  return rules;
}

const char* name_of(LearningResult result) {
  switch (result) {
    case LearningResult::ok:
      return "ok";
    case LearningResult::nonfinite:
      return "nonfinite";
    case LearningResult::nodata:
      return "nodata";
    case LearningResult::slope:
      return "slope";
  }
  return "?";
}

json learning(const json& in) {
  std::vector<double> t = numbers(in.at("t"));
  std::vector<double> y(t.size());
  std::vector<NodeSums> nodes;
  for (std::size_t j = 0; j < t.size(); ++j)
    nodes.push_back({in.at("n").at(j).get<std::uint32_t>(), number(in.at("sum").at(j)),
                     number(in.at("sumsq").at(j))});
  const LearningReport report = learning_update(rules_of(in.at("params")), nodes, t, y);
  return {{"t", t}, {"status", name_of(report.result)}, {"y", y}};
}

double rms(const std::vector<double>& d, const std::vector<double>& t) {
  double squares = 0.0;
  for (std::size_t j = 0; j < d.size(); ++j)
    squares += (d[j] + t[j]) * (d[j] + t[j]);
  return std::sqrt(squares / static_cast<double>(d.size()));
}

json learning_sequence(const json& in) {
  const LearningRules rules = rules_of(in.at("params"));
  const std::vector<double> d = numbers(in.at("d"));
  std::vector<double> t(d.size(), 0.0);
  std::vector<double> y(d.size());
  json out{{"rms0", rms(d, t)}, {"sequence", json::array()}};
  for (int k = 0; k < in.at("updates").get<int>(); ++k) {
    std::vector<NodeSums> nodes(d.size());
    for (std::size_t j = 0; j < d.size(); ++j)
      nodes[j].add(d[j] + t[j]);
    learning_update(rules, nodes, t, y);
    out["sequence"].push_back({{"t", t}, {"rms", rms(d, t)}});
  }
  return out;
}

json table_eval(const json& in) {
  const std::vector<double> t = numbers(in.at("t"));
  json v = json::array();
  for (const json& q : in.at("q"))
    v.push_back(uniform_table_value(t, number(in.at("q0")), number(in.at("h")),
                                    in.at("periodic").get<bool>(), number(q)));
  return {{"v", v}};
}

json guard(const json& in) {
  LearningGuard guard;
  json actions = json::array();
  for (const json& J : in.at("J")) {
    const GuardAction action = guard.judge(number(J));
    actions.push_back(action == GuardAction::keep   ? "keep"
                      : action == GuardAction::hold ? "hold"
                                                    : "rollback");
  }
  return {{"action", actions}};
}

json monitor(const json& in) {
  RunningStatistics statistics;
  OrderLine order;
  const bool has_order = in.contains("order");
  const json& samples = in.at("samples");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double v = number(samples.at(i));
    if (!statistics.add(v) || !has_order) continue;
    const double angle = number(in.at("order")) * number(in.at("angles").at(i));
    const FineSineCosine at = fine_sine_cosine(units_within_a_turn(angle));
    order.add(v, at.cosine, at.sine);
  }
  json out{{"n", statistics.count()}, {"mean", statistics.mean()}, {"std", statistics.deviation()},
           {"rms", statistics.rms()}, {"peak", statistics.peak()}, {"bad", statistics.bad()}};
  if (has_order) {
    out["order_amp"] = spectral_line(order).amplitude;
    out["order_phase"] = spectral_line(order).phase;
  }
  return out;
}

}  // namespace

void add_s3_learning(Handlers& handlers) {
  handlers["s3.learning"] = learning;
  handlers["s3.learning_sequence"] = learning_sequence;
  handlers["s3.table_eval"] = table_eval;
  handlers["s3.guard"] = guard;
  handlers["s3.monitor"] = monitor;
}

}  // namespace volcomp::cases
