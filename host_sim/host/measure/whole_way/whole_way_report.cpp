#include "host_sim/host/measure/whole_way/whole_way_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/whole_way/whole_way_charts.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr std::size_t kMostFullPlaces = 4;  // whose every figure a terminal shows

double in_um(double mm) { return kUmPerMm * mm; }
json um_or_null(const std::optional<double>& mm) { return mm ? json(in_um(*mm)) : json(); }
json ratio_or_null(const DrawnNumber& n) { return n.ratio() ? json(*n.ratio()) : json(); }

const char* travel_text(Travel travel) {
  if (travel == Travel::forward) return "up";
  return travel == Travel::backward ? "down" : "mean";
}

json number_json(const DrawnNumber& n) {
  return {{"um", in_um(n.nominal)},      {"mean_um", in_um(n.mean)},
          {"sd_um", in_um(n.deviation)}, {"low_um", in_um(n.low)},
          {"high_um", in_um(n.high)},    {"first_order_um", um_or_null(n.first_order)},
          {"ratio", ratio_or_null(n)}};
}

json interval_in_json(const FigureInterval& i) {
  return {{"corrected_um", in_um(i.corrected)},
          {"low_um", in_um(i.low)},
          {"high_um", in_um(i.high)},
          {"upper95_um", in_um(i.upper95)}};
}

// mm, degrees of rotary axes.
json place_json(const Pose& at, const MachineFile& machine) {
  json place = json::object();
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const bool rotary = machine.axes[a].rotary;
    place[fmt::format("{}_{}", machine.axes[a].letter, rotary ? "deg" : "mm")] =
        rotary ? at[a] * kDegPerRad : at[a];
  }
  return place;
}

json stated_json(const CampaignStatement& stated) {
  json list = json::object();
  for (const CampaignField& field : campaign_fields())
    if (stated.*field.member) list[field.key] = *(stated.*field.member);
  return list;
}

json columns_of_number() {
  return {column("E", "µm", 2),           column("mean − E", "µm", 2), column("sd", "µm", 3),
          column("first order", "µm", 3), column("ratio", "", 3),      column("2.5 %", "µm", 2),
          column("97.5 %", "µm", 2)};
}

void add_number(json& row, const DrawnNumber& n) {
  row.push_back(in_um(n.nominal));
  row.push_back(in_um(n.mean - n.nominal));
  row.push_back(in_um(n.deviation));
  row.push_back(um_or_null(n.first_order));
  row.push_back(ratio_or_null(n));
  row.push_back(in_um(n.low));
  row.push_back(in_um(n.high));
}

json full_table(const WholeWayQuestion& q, const TaskUncertainty& u) {
  json columns = json::array({plain_column("place"), plain_column("error")});
  for (json& one : columns_of_number())
    columns.push_back(std::move(one));
  json rows = json::array();
  for (const PlaceUncertainty& place : u.places) {
    for (std::size_t c = 0; c < 3; ++c) {
      json row =
          json::array({c == 0 ? place_text(place.at, q.machine) : "", kErrorComponents.at(c)});
      add_number(row, place.error.at(c));
      rows.push_back(std::move(row));
    }
  }
  return table_section("Uncertainty of the error of the tool point", std::move(columns),
                       std::move(rows));
}

// The ratio of the three that is farthest from 1.
json farthest_ratio(const PlaceUncertainty& place) {
  json farthest;
  for (const DrawnNumber& n : place.error) {
    const std::optional<double> ratio = n.ratio();
    if (!ratio) continue;
    if (farthest.is_null() || std::abs(*ratio - 1.0) > std::abs(farthest.get<double>() - 1.0))
      farthest = *ratio;
  }
  return farthest;
}

json short_table(const WholeWayQuestion& q, const TaskUncertainty& u) {
  json columns = json::array({plain_column("place")});
  for (const char* component : kErrorComponents)
    columns.push_back(column(fmt::format("sd {}", component), "µm", 3));
  for (const char* component : kErrorComponents)
    columns.push_back(column(fmt::format("first order {}", component), "µm", 3));
  columns.push_back(column("ratio farthest from 1", "", 3));
  json rows = json::array();
  for (const PlaceUncertainty& place : u.places) {
    json row = json::array({place_text(place.at, q.machine)});
    for (const DrawnNumber& n : place.error)
      row.push_back(in_um(n.deviation));
    for (const DrawnNumber& n : place.error)
      row.push_back(um_or_null(n.first_order));
    row.push_back(farthest_ratio(place));
    rows.push_back(std::move(row));
  }
  return table_section("Uncertainty of the error of the tool point", std::move(columns),
                       std::move(rows));
}

std::string note_of_places(const WholeWayQuestion& q) {
  return fmt::format(
      "E: what the tables predict, tool point in base, direction of travel {}. sd and the limits "
      "are those of {} draws, seed {}. For what is linear in the readings the ratio to first "
      "order lies within 1 ± {:.3f}.",
      travel_text(q.settings.travel), q.settings.draws, q.settings.seed,
      TaskUncertainty::ratio_band(q.settings.draws));
}

json figures_section(const TaskUncertainty& u) {
  json columns = json::array({plain_column("figure")});
  for (json& one : columns_of_number())
    columns.push_back(std::move(one));
  for (const char* title : {"true: corrected", "95 % from", "to", "upper bound"})
    columns.push_back(column(title, "µm", 2));
  json rows = json::array();
  for (const TaskFigure& figure : u.figures) {
    json row = json::array({figure.name});
    add_number(row, figure.drawn);
    if (figure.truth) {
      for (const double mm :
           {figure.truth->corrected, figure.truth->low, figure.truth->high, figure.truth->upper95})
        row.push_back(in_um(mm));
    } else {
      row.insert(row.end(), 4, json());
    }
    rows.push_back(std::move(row));
  }
  return with_id("task", table_section("Over the task", std::move(columns), std::move(rows)),
                 "Extremes: noise makes them larger, so the mean is shifted, and first order need "
                 "not hold. The true figure, at these places, is estimated as verify does it.");
}

json shares_section(const WholeWayQuestion& q, const TaskUncertainty& u) {
  json rows = json::array();
  for (const GroupShare& share : u.shares)
    rows.push_back({share.group, in_um(share.u(0)), in_um(share.u(1)), in_um(share.u(2))});
  json columns = json::array({plain_column("from")});
  for (const char* component : kErrorComponents)
    columns.push_back(column(component, "µm", 3));
  return with_id("shares",
                 table_section(fmt::format("Where it comes from, at {}",
                                           place_text(u.places.at(u.worst).at, q.machine)),
                               std::move(columns), std::move(rows)),
                 "To first order; the place with the largest uncertainty. Squares add up.");
}

json not_stated_section(const TaskUncertainty& u) {
  std::vector<std::string> lines = u.remarks;
  for (const std::string& name : u.drawn_as_zero)
    lines.push_back(fmt::format("not stated, drawn as 0: {}", name));
  return text_section("", lines);
}

std::string runs_in_words(const RunsFile& runs) {
  return fmt::format("{} {}/{}", runs.letter, runs.up.size(), runs.down.size());
}

std::string asked_in_words(const WholeWayQuestion& q, const TaskUncertainty& u) {
  std::string runs;
  for (const RunsFile& file : q.runs)
    runs += (runs.empty() ? "" : ", ") + runs_in_words(file);
  return fmt::format("{}, CRC-32 {:08X}; runs up/down: {}; {} inputs; {}: {} place{}", q.image,
                     q.crc, runs, u.inputs, q.task.name, q.task.places.size(),
                     q.task.places.size() == 1 ? "" : "s");
}

}  // namespace

json uncertainty_json(const WholeWayQuestion& q, const TaskUncertainty& u) {
  json places = json::array();
  for (const PlaceUncertainty& place : u.places) {
    json one{{"at", place_json(place.at, q.machine)}};
    for (std::size_t c = 0; c < 3; ++c)
      one[kErrorComponents.at(c)] = number_json(place.error.at(c));
    places.push_back(std::move(one));
  }
  json figures = json::object();
  for (const TaskFigure& figure : u.figures) {
    json& one = figures[figure.key] = number_json(figure.drawn);
    if (figure.truth) one["true"] = interval_in_json(*figure.truth);
  }
  json shares = json::array();
  for (const GroupShare& share : u.shares)
    shares.push_back(
        {{"from", share.group},
         {"first_order_um", {in_um(share.u(0)), in_um(share.u(1)), in_um(share.u(2))}}});
  return {{"version", kVersion},
          {"image", q.image},
          {"crc32", fmt::format("{:08X}", q.crc)},
          {"machine", q.machine.name},
          {"machine_id", q.machine.id},
          {"direction", travel_text(q.settings.travel)},
          {"draws", q.settings.draws},
          {"seed", q.settings.seed},
          {"inputs", u.inputs},
          {"ratio_band", TaskUncertainty::ratio_band(q.settings.draws)},
          {"stated", stated_json(q.stated)},
          {"drawn_as_zero", u.drawn_as_zero},
          {"remarks", u.remarks},
          {"places", places},
          {"task", figures},
          {"shares", {{"place", u.worst + 1}, {"groups", shares}}}};
}

json uncertainty_document(const WholeWayQuestion& q, const TaskUncertainty& u,
                          const RunContext& run, Origins origins) {
  const bool few = u.places.size() <= kMostFullPlaces;
  origins.data = "measured: what the files hold";
  origins.warnings = u.remarks;
  origins.settings = {{"draws", fmt::format("{}", q.settings.draws)},
                      {"seed", fmt::format("{}", q.settings.seed)},
                      {"direction of travel", travel_text(q.settings.travel)}};
  for (const CampaignField& field : campaign_fields())
    if (q.stated.*field.member)
      origins.settings.emplace_back(field.key, fmt::format("{:g}", *(q.stated.*field.member)));
  ReportParts parts;
  parts.title = "Uncertainty of a task";
  parts.subtitle = asked_in_words(q, u);
  parts.before_after =
      with_id("places", few ? full_table(q, u) : short_table(q, u), note_of_places(q));
  if (u.places.size() > 1) parts.plots = task_charts(q, u);
  parts.plots.push_back(share_bars(u));
  if (!u.figures.empty()) parts.details.push_back(in_summary(figures_section(u)));
  parts.details.push_back(in_summary(shares_section(q, u)));
  if (!few) parts.details.push_back(with_id("all", full_table(q, u)));
  parts.details.push_back(in_summary(with_id("not-stated", not_stated_section(u))));
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

std::string uncertainty_text(const WholeWayQuestion& q, const TaskUncertainty& u) {
  return asked_in_words(q, u) + "\n" + terminal_text(uncertainty_document(q, u, {}, {}));
}

}  // namespace volcomp::host
