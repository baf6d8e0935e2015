#pragma once
// The draws of a run that may go in parts (parts_of_run.hpp): computed on several threads, written
// to a part, read back from all parts.

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/report/parts_of_run.hpp"
#include "host_sim/host/report/shared_progress.hpp"

namespace volcomp::host {

struct DrawPlan {
  std::size_t count = 1;  // draws of the whole run
  Shard shard{};          // those among them that are computed
  std::size_t threads = 1;

  [[nodiscard]] std::vector<std::size_t> own() const { return shard.draws_of(count); }
};

// Results of `one(draw, progress)` for the plan's own draws, in their order: the same for any
// number of threads. `what`: a draw, for the progress.
template <class One>
[[nodiscard]] auto run_draws(const DrawPlan& plan, const std::string& what,
                             const Progress& progress, const One& one) {
  const std::vector<std::size_t> own = plan.own();
  std::vector<std::decay_t<decltype(one(std::size_t{}, progress))>> results(own.size());
  SharedProgress shared(progress, own.size());
  in_parallel(own.size(), plan.threads, [&](std::size_t i) {
    const std::string text = fmt::format("{} {} of {}", what, own[i] + 1, plan.count);
    const Progress of_draw = [&](double done, const std::string&) { shared.show(i, done, text); };
    results[i] = one(own[i], of_draw);
  });
  progress(1.0, "done");
  return results;
}

// What run_draws() has found, as a part. `run`: what is alike in all parts.
template <class Result, class ToJson>
[[nodiscard]] PartialRun part_of_draws(const std::string& experiment, const DrawPlan& plan,
                                       const nlohmann::json& run,
                                       const std::vector<Result>& results, const ToJson& to_json) {
  PartialRun part{experiment, plan.count, run, nlohmann::json::object(), {}};
  const std::vector<std::size_t> own = plan.own();
  for (std::size_t i = 0; i < own.size(); ++i)
    part.draw[own[i]] = to_json(results.at(i));
  return part;
}

// The results of all draws in their order, one at least. Throws UserError.
template <class FromJson>
[[nodiscard]] auto results_of_draws(const PartialRun& all, const FromJson& from_json) {
  if (all.draw.empty()) throw UserError("the parts are of a run without draws");
  std::vector<decltype(from_json(all.draw.begin()->second))> results;
  for (const auto& [number, draw] : all.draw)
    results.push_back(from_json(draw));
  return results;
}

}  // namespace volcomp::host
