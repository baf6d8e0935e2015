#include "host_sim/host/measure/identify/found_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

// More than these a function is weakly known, k = 1.
constexpr double kWeak_mm = 5e-3;
constexpr double kWeak_rad = 20e-6;

const char* unit_name(const Quantity& quantity) { return quantity.angular() ? "urad" : "um"; }

bool weak(const FoundFunction& f) {
  return f.largest_u() > (f.quantity.angular() ? kWeak_rad : kWeak_mm);
}

// Largest less smallest value.
double range_of(const FoundFunction& f) {
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (const Measured& v : f.value) {
    least = std::min(least, v.value);
    most = std::max(most, v.value);
  }
  return most - least;
}

json function_rows(const std::vector<FoundFunction>& functions, bool values) {
  json rows = json::array();
  for (const FoundFunction& f : functions) {
    json row = json::array({f.quantity.name});
    if (values) row.push_back(shown(f.quantity, range_of(f)));
    row.push_back(kCover * shown(f.quantity, f.largest_u()));
    row.push_back(shown_unit(f.quantity));
    row.push_back(weak(f) ? "weak" : "");
    rows.push_back(row);
  }
  return rows;
}

json value_row(const std::string& name, const Measured& m, double scale, const char* unit,
               bool measured) {
  json row = json::array({name});
  if (measured) row.push_back(scale * m.value);
  row.push_back(kCover * scale * m.u);
  row.push_back(unit);
  return row;
}

}  // namespace

double shown(const Quantity& quantity, double value) {
  return value * (quantity.angular() ? kUradPerRad : kUmPerMm);
}

const char* shown_unit(const Quantity& quantity) { return quantity.angular() ? "µrad" : "µm"; }

json function_section(const std::vector<FoundFunction>& functions, bool measured) {
  json columns = json::array({plain_column("function")});
  if (measured) columns.push_back(column("range", "", 2));
  columns.push_back(column("largest U (k = 2)", "", 2));
  columns.push_back(plain_column(""));
  columns.push_back(plain_column(""));
  return table_section("Error functions (body, moving side)", columns,
                       function_rows(functions, measured));
}

json value_section(const std::vector<FoundValue>& values,
                   const std::optional<FoundSquareness>& squareness, bool measured) {
  if (values.empty() && !squareness) return {};
  json rows = json::array();
  if (squareness) {
    const auto add = [&](const char* name, const Measured& m) {
      rows.push_back(value_row(name, m, kUradPerRad, "µrad", measured));
    };
    add("squareness a_xy, Y the datum", squareness->a_xy);
    add("squareness a_xz", squareness->a_xz);
    add("squareness a_yz", squareness->a_yz);
  }
  for (const FoundValue& v : values)
    rows.push_back(value_row(v.quantity.name, v.value, shown(v.quantity, 1.0),
                             shown_unit(v.quantity), measured));
  json columns = json::array({plain_column("")});
  if (measured) columns.push_back(column("value", "", 2));
  columns.push_back(column("U (k = 2)", "", 2));
  columns.push_back(plain_column(""));
  return table_section("Squareness, reversals, places of rotary axes", columns, rows);
}

std::string volume_line(const FoundVolume& v) {
  return fmt::format(
      "Error of the functional point over the travels, beside the best rigid motion: u {:.2f} µm "
      "rms; on the average {:.2f} µm are left at 95 % of the places, {:.2f} µm at the worst",
      kUmPerMm * v.rms, kUmPerMm * v.p95, kUmPerMm * v.max);
}

json volume_json(const FoundVolume& v) {
  return {{"rms_um", kUmPerMm * v.rms}, {"p95_um", kUmPerMm * v.p95}, {"max_um", kUmPerMm * v.max}};
}

json functions_json(const MeasurementPlan& plan, const std::vector<FoundFunction>& functions) {
  json out = json::array();
  for (const FoundFunction& f : functions) {
    const AxisFile& axis = plan.machine.axes[f.quantity.axis];
    json at = json::array();
    json value = json::array();
    json u = json::array();
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      at.push_back(axis.rotary ? kDegPerRad * f.at[k] : f.at[k]);
      value.push_back(shown(f.quantity, f.value[k].value));
      u.push_back(shown(f.quantity, f.value[k].u));
    }
    out.push_back({{"name", f.quantity.name},
                   {"axis", std::string(1, axis.letter)},
                   {"channel", kChannelNames.at(f.quantity.channel)},
                   {"at_unit", axis.rotary ? "deg" : "mm"},
                   {"unit", unit_name(f.quantity)},
                   {"at", at},
                   {"value", value},
                   {"u", u},
                   {"weak", weak(f)}});
  }
  return out;
}

json values_json(const std::vector<FoundValue>& values) {
  json out = json::array();
  for (const FoundValue& v : values)
    out.push_back({{"name", v.quantity.name},
                   {"unit", unit_name(v.quantity)},
                   {"value", shown(v.quantity, v.value.value)},
                   {"u", shown(v.quantity, v.value.u)}});
  return out;
}

json plan_json(const MeasurementPlan& plan) {
  return {{"plan", plan.path},
          {"machine", plan.machine.name},
          {"machine_id", plan.machine.id},
          {"positions", plan.commanded ? "command" : "actual"},
          {"temperature_C", plan.temperature_C}};
}

std::string functions_csv(const MeasurementPlan& plan,
                          const std::vector<FoundFunction>& functions) {
  std::string text = "function,position,unit of position,value,u,unit\n";
  for (const FoundFunction& f : functions) {
    const bool rotary = plan.machine.axes[f.quantity.axis].rotary;
    for (std::size_t k = 0; k < f.at.size(); ++k)
      text += fmt::format("{},{:.6f},{},{:.4f},{:.4f},{}\n", f.quantity.name,
                          rotary ? kDegPerRad * f.at[k] : f.at[k], rotary ? "deg" : "mm",
                          shown(f.quantity, f.value[k].value), shown(f.quantity, f.value[k].u),
                          unit_name(f.quantity));
  }
  return text;
}

}  // namespace volcomp::host::identify
