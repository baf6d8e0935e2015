#include "host_sim/experiments/any_machine/judged_spread.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/parts_of_run.hpp"

namespace volcomp::any_machine {

using nlohmann::json;

json judged_json(const JudgedMachine& machine) {
  json figures = json::array();
  for (const host::BeforeAfter& f : machine.figures)
    figures.push_back({{"figure", f.figure}, {"um", {f.before, f.after}}});
  return {{"figures", std::move(figures)}, {"good", machine.good}};
}

JudgedMachine judged_of(const json& draw) {
  JudgedMachine machine;
  for (const json& f : draw.at("figures")) {
    const auto um = host::numbers_of<2>(f.at("um"), "um");
    machine.figures.push_back({host::text_of_part(f.at("figure"), "figure"), um[0], um[1]});
  }
  machine.good = draw.at("good").get<bool>();
  return machine;
}

void require_same_figures(const std::vector<JudgedMachine>& drawn) {
  const std::vector<host::BeforeAfter>& first = drawn.front().figures;
  const auto same = [&first](const JudgedMachine& m) {
    return std::equal(m.figures.begin(), m.figures.end(), first.begin(), first.end(),
                      [](const auto& a, const auto& b) { return a.figure == b.figure; });
  };
  if (first.empty() || !std::all_of(drawn.begin(), drawn.end(), same))
    throw host::UserError("the machines of the parts have different figures");
}

host::RangeOfDraws range_over(const std::vector<JudgedMachine>& drawn, std::size_t figure,
                              double host::BeforeAfter::*value) {
  std::vector<double> values;
  values.reserve(drawn.size());
  for (const JudgedMachine& m : drawn)
    values.push_back(m.figures.at(figure).*value);
  return host::range_of_draws(values);
}

// Every machine has the same figures.
json spread_table(const std::vector<JudgedMachine>& drawn, const std::string& note) {
  json rows = json::array();
  for (std::size_t f = 0; f < drawn.front().figures.size(); ++f) {
    const host::RangeOfDraws before = range_over(drawn, f, &host::BeforeAfter::before);
    const host::RangeOfDraws after = range_over(drawn, f, &host::BeforeAfter::after);
    rows.push_back({drawn.front().figures[f].figure, before.median, before.least, before.most,
                    after.median, after.least, after.most});
  }
  json made = host::table_section(
      fmt::format("{} machines, largest deviations before and after", drawn.size()),
      {host::plain_column("figure", "figure"),
       host::column("before: median", "µm", 2, "before_median_um"),
       host::column("least", "µm", 2, "before_least_um"),
       host::column("most", "µm", 2, "before_most_um"),
       host::column("after: median", "µm", 2, "after_median_um"),
       host::column("least", "µm", 2, "after_least_um"),
       host::column("most", "µm", 2, "after_most_um")},
      rows);
  made["name"] = "machines";
  return host::in_summary(host::with_id("machines", std::move(made), note));
}

json what_is_left(const std::vector<JudgedMachine>& drawn) {
  json series = json::array();
  for (std::size_t f = 0; f < drawn.front().figures.size(); ++f) {
    std::vector<double> values;
    values.reserve(drawn.size());
    for (const JudgedMachine& m : drawn)
      values.push_back(m.figures[f].after);
    series.push_back({{"name", drawn.front().figures[f].figure}, {"values", values}});
  }
  return host::with_id("left", {{"type", "histogram"},
                                {"title", "What compensation leaves"},
                                {"x", host::axis_label("largest deviation", "µm")},
                                {"series", series}});
}

}  // namespace volcomp::any_machine
