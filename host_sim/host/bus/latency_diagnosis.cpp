#include "host_sim/host/bus/latency_diagnosis.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "firmware/node/cia402_words.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/report/json_format.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;
using nlohmann::json;
using node::Way;

bool is_forwarded(const json& axis) {
  return axis["way"] == static_cast<unsigned>(Way::forwarded_target);
}

CycleAxes cycle_axes(NodeClient& client, const json& axes) {
  CycleAxes all;
  for (const json& axis : axes) {
    const auto number = axis["axis"].get<std::size_t>() - 1;
    all.push_back({static_cast<Way>(axis["way"].get<unsigned>()),
                   client.read(object::confirms[number]) != 0});
  }
  return all;
}

// Letter or number of each.
std::string names_of(const json& axes) {
  std::string names;
  for (const json& axis : axes)
    names += (names.empty() ? "" : ", ") + axis.get<std::string>();
  return names;
}

std::string name_of(const json& axis) {
  const std::string letter = axis["letter"];
  return letter.empty() ? axis["axis"].dump() : letter;
}

// Nothing where no object tells.
json why_not_served(std::uint8_t mapped_way, std::uint16_t status, std::int8_t mode) {
  if (mapped_way == node::kNobody)
    return "the mapping of its drive has not been read back since it booted (2037h = 255)";
  if (mapped_way != static_cast<std::uint8_t>(Way::forwarded_target))
    return fmt::format("its drive is mapped for way {} (2037h)", mapped_way);
  if (node::operation_enabled(status) && mode != node::kCyclicPosition)
    return fmt::format("its drive is in mode {}, not in cyclic synchronous position (201Bh)", mode);
  return nullptr;
}

}  // namespace

std::vector<std::string> latency_problems(const CycleAxes& axes, const LatencyBudget& budget,
                                          const MeasuredLatency& measured, bool probing) {
  std::vector<std::string> problems;
  const std::int64_t largest = measured.largest;
  const auto compare = [&](std::int64_t most, const char* when) {
    if (largest > most)
      problems.push_back(fmt::format("{} us too long {}: at most {} us are left there",
                                     largest - most, when, std::max<std::int64_t>(most, 0)));
  };
  compare(budget.usual, "when every target has come");
  if (probing) compare(budget.with_edge, "while the drives report an edge of the probe");
  if (!forwards_targets(axes)) return problems;
  compare(budget.after_deadline, "after a deadline");
  const std::int64_t until = budget.deadline_until(largest);
  if (budget.deadline > budget.deadline_from && budget.deadline < until) return problems;
  problems.push_back(
      until > budget.deadline_from + 1
          ? fmt::format("the deadline (2200h:03) is {} us after SYNC and must lie between {} and "
                        "{} us",
                        budget.deadline, budget.deadline_from, until)
          : fmt::format("no deadline (2200h:03) is right: it must come later than {} us after SYNC "
                        "and before {} us",
                        budget.deadline_from, until));
  return problems;
}

json diagnose_latency(NodeClient& client, const json& axes) {
  json d = json::object();
  read_facts(client, d, object::latency_cycles, object::latency_least_us, object::latency_median_us,
             object::latency_most_us, object::latency_largest_us, object::latency_targets_us,
             object::deadline_us);
  const std::uint32_t period_us = client.read(object::cycle_period_us);
  d["period_us"] = period_us;
  d["fits"] = nullptr;
  d["problems"] = json::array();
  if (axes.empty() || period_us == 0) return d;
  const CycleAxes all = cycle_axes(client, axes);
  const LatencyBudget budget =
      latency_budget(all, {period_us, d["deadline_us"], d["latency_targets_us"]});
  d["allowed"] = {{"usual_us", budget.usual},
                  {"with_edge_us", budget.with_edge},
                  {"after_deadline_us", budget.after_deadline},
                  {"last_target_us", budget.last_target},
                  {"deadline_from_us", budget.deadline_from},
                  {"deadline_until_us", budget.deadline_until(d["latency_largest_us"])}};
  d["deadline_us"] = budget.deadline;
  if (d["latency_cycles"] == 0) return d;
  const bool probing = client.find(object::probe::command).value_or(0) != 0;
  d["problems"] =
      latency_problems(all, budget, {d["latency_cycles"], d["latency_largest_us"]}, probing);
  d["fits"] = d["problems"].empty();
  return d;
}

std::string describe_latency(const json& d) {
  if (d["latency_cycles"] == 0)
    return d.contains("allowed") ? fmt::format(
                                       "not measured yet; at most {} us, {} us after a "
                                       "deadline",
                                       d["allowed"]["usual_us"], d["allowed"]["after_deadline_us"])
                                 : "not measured yet";
  std::string text = fmt::format(
      "{} to {} us in {} cycles, half of them below {}, 99.9 % below {}; last target {} us after "
      "SYNC",
      d["latency_least_us"], d["latency_largest_us"], d["latency_cycles"], d["latency_median_us"],
      d["latency_most_us"], d["latency_targets_us"]);
  if (d["fits"].is_null()) return text + "; without a period in 1006h nothing to compare it with";
  const json& most = d["allowed"];
  text +=
      fmt::format("; {}, at most {} us, {} us with an edge of the probe, {} us after a deadline",
                  d["fits"] == true ? "fits" : "DOES NOT FIT", most["usual_us"],
                  most["with_edge_us"], most["after_deadline_us"]);
  for (const json& problem : d["problems"])
    text += "; " + problem.get<std::string>();
  return text;
}

void add_way_facts(NodeClient& client, std::size_t axis, json& facts) {
  read_facts(client, facts, object::way[axis], object::mapped_way[axis], object::drive_mode[axis]);
  facts["not_served"] = nullptr;
  if (is_forwarded(facts))
    facts["not_served"] =
        why_not_served(facts["mapped_way"], facts["drive_status"], facts["drive_mode"]);
}

std::string describe_way(const json& axis) {
  switch (static_cast<Way>(axis["way"].get<unsigned>())) {
    case Way::forwarded_target:
      return axis["not_served"].is_null()
                 ? "  takes its targets from the node\n"
                 : fmt::format("  takes its targets from the node, and gets none: {}\n",
                               axis["not_served"].get<std::string>());
    case Way::controller_adds:
      return "  the controller adds the offset\n";
    case Way::none:
      return "  takes no correction (2034h = 4)\n";
    default:
      return "";
  }
}

json diagnose_forwarding(NodeClient& client, const json& axes) {
  json forwarded = json::array();
  json known = json::array();
  for (const json& axis : axes) {
    if (!is_forwarded(axis)) continue;
    forwarded.push_back(name_of(axis));
    if (!axis["not_served"].is_null()) known.push_back(name_of(axis));
  }
  if (forwarded.empty()) return nullptr;
  json d{{"axes", forwarded}, {"not_served", known}};
  d["incomplete"] = (client.read(object::any_status) & node::kForwardingIncomplete) != 0;
  read_facts(client, d, object::not_forwarded);
  return d;
}

std::string describe_forwarding(const json& d) {
  std::string count =
      fmt::format("targets to axis {}, {} not forwarded", names_of(d["axes"]), d["not_forwarded"]);
  if (d["incomplete"] != true) return count;
  if (!d["not_served"].empty())
    return fmt::format("{}; NOT SERVED (bit 15 of 2600h:03): axis {}, see below", count,
                       names_of(d["not_served"]));
  return count +
         "; an axis is NOT SERVED (bit 15 of 2600h:03): it got no target of the controller in the "
         "last cycle, its drive has not been seen disabled since the start of the node, or "
         "forwarding has ended (FF23h)";
}

}  // namespace volcomp::host
