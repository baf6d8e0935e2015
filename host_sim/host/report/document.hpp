#pragma once
// One design for the reports of all scenarios: contents, order and headings. docs/report.md
// explains how to read them, host_sim/host/report/page/README.md the kinds of sections.
//
// A scenario fills ReportParts from its result and hands it to report_document():
//
//   ReportParts parts;
//   parts.title = "…";
//   parts.verdict = my_verdict(result);
//   parts.before_after = before_after_table({{"largest deviation", 41.2, 0.4}}, "…");
//   parts.plots = {volume_map(…), positioning_group(…), lines_chart(…)};
//   parts.details = {in_summary(my_table(result))};
//   parts.ticks = run.ticks;
//   parts.provenance = provenance(run, my_origins(result));
//   return report_document(std::move(parts));
//
// Parts for all scenarios are beside this file: before_after, positioning (ISO 230-2),
// error_functions, pitch_charts, volume, tick_tables, provenance; charts.hpp and report_parts.hpp
// have the small ones. Every number comes from the result: a text that names one is made with fmt.
// The command (cli/run_experiment.hpp) gives RunContext: a RunView is the MachineWatch of every
// machine of the run, `watched()` of controller/bus_axes.hpp and `watched_integrated_cells()` show
// machines to it; write_pages() ends the run. A scenario without control periods leaves `ticks`
// out, and the report has no statistics.

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/report/progress.hpp"

namespace volcomp::host {

// Makes tables of what the compensation did in all control periods; an empty list without periods.
using TickTables = std::function<nlohmann::json()>;

// What a report has to know of the run besides its result.
struct RunContext {
  std::string command;    // as the user has typed it
  std::string transport;  // where the compensation was done; empty: nothing was compensated
  TickTables ticks = nullptr;
};

struct ReportParts {
  std::string title;
  std::string subtitle;
  std::optional<Verdict> verdict;                  // none: nothing was to be judged
  nlohmann::json before_after;                     // before_after.hpp; null: none
  nlohmann::json plots = nlohmann::json::array();  // what was measured
  nlohmann::json details = nlohmann::json::array();
  TickTables ticks = nullptr;
  nlohmann::json provenance;  // provenance.hpp
};

// Before and after, plots, details, tick statistics, provenance.
[[nodiscard]] nlohmann::json report_document(ReportParts parts);

// A table or text that the terminal shows as well as the page.
[[nodiscard]] nlohmann::json in_summary(nlohmann::json section);
// The document for a terminal: the result, what is in_summary(), and the verdict.
[[nodiscard]] std::string terminal_text(const nlohmann::json& document);

}  // namespace volcomp::host
