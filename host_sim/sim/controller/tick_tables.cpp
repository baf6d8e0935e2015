#include "host_sim/sim/controller/tick_tables.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::sim {
namespace {

using nlohmann::json;

struct BitColumn {
  StatusBit bit;
  const char* title;
};
constexpr std::array<BitColumn, 6> kBits{{{kClamped, "clamped"},
                                          {kRateLimited, "slew limited"},
                                          {kRamping, "ramping"},
                                          {kStale, "stale"},
                                          {kOutOfRange, "beyond table"},
                                          {kDirectionUnknown, "direction unknown"}}};

// As many decimals as mean something, for a column that holds counts too.
double hundredths(double value) { return std::round(100.0 * value) / 100.0; }

json axis_row(const AxisTicks& axis) {
  const double micro = axis.rotary ? 1e6 / kUnitsPerRad : kUmPerMm / kNmPerMm;
  json row = {std::string(1, axis.letter), micro * static_cast<double>(axis.largest_offset),
              micro * static_cast<double>(axis.largest_change), axis.rotary ? "µrad" : "µm"};
  for (const BitColumn& column : kBits)
    row.push_back(axis.reported > 0 ? json(axis.periods.at(bit_of(column.bit))) : json(nullptr));
  return row;
}

json axis_table(const TickStatistics& ticks) {
  json columns = json::array({{{"title", "axis"}},
                              host::column("largest correction", "", 2),
                              host::column("largest change per period", "", 3),
                              {{"title", "unit"}}});
  for (const BitColumn& bit : kBits)
    columns.push_back(host::column(bit.title, "periods", 0));
  json rows = json::array();
  for (const AxisTicks& axis : ticks.axes())
    rows.push_back(axis_row(axis));
  return {{"type", "table"},
          {"id", "ticks-axes"},
          {"title", "Corrections by axis"},
          {"columns", columns},
          {"rows", rows},
          {"note",
           "Over all control periods of the run, those of uncompensated machines and of starting "
           "up included. A dash: the node is in another process and tells its states of all axes "
           "together only."}};
}

json run_table(const TickStatistics& ticks) {
  json rows = json::array();
  const auto row = [&rows](const char* what, json value, const char* unit) {
    rows.push_back(json::array({what, std::move(value), unit}));
  };
  row("machines, one after the other", ticks.machines(), "");
  row("control periods", ticks.periods(), "");
  row("machine time", hundredths(ticks.machine_time_s()), "s");
  row("edges of the touch probe latched, all axes", ticks.latches(), "");
  if (ticks.on_a_bus()) {
    row("frames on the bus", ticks.frames(), "");
    row("bus load, without stuff bits", hundredths(100.0 * ticks.bus_load()), "%");
    row("cycles incomplete at the deadline", ticks.deadlines_missed(), "");
    row("emergency messages", ticks.emergencies(), "");
  }
  return {{"type", "table"},
          {"id", "ticks-run"},
          {"title", "The run in control periods"},
          {"columns", {{{"title", "quantity"}}, {{"title", "value"}}, {{"title", "unit"}}}},
          {"rows", rows}};
}

}  // namespace

json tick_tables(const TickStatistics& ticks) {
  return json::array({axis_table(ticks), run_table(ticks)});
}

}  // namespace volcomp::sim
