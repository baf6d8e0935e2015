#include "host_sim/host/tables/formats/isg_ssfk.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMostEntries = 1500;
constexpr double kPerUnit = 1e4;  // of 0.1 µm in a mm, of 0.0001 degree in a degree
constexpr const char* kTable = "kw.ssfk.table[";

double file_units(bool rotary) { return kPerUnit * (rotary ? 180.0 / kPi : 1.0); }

std::string column(const char* name, const std::vector<double>& values, double units) {
  std::string out;
  for (std::size_t k = 0; k < values.size(); ++k)
    out += fmt::format("{}{}].{} {}\n", kTable, k, name, nearest(values[k] * units));
  return out;
}

}  // namespace

Status write_ssfk(const SsfkTable& table, std::string& text) {
  Where where;
  where.field = "axis";
  if (table.axis.empty()) return refuse(Reason::bad_setting, where);
  if (table.forward.size() != table.reverse.size()) return refuse(Reason::length_mismatch);
  const double units = file_units(table.rotary);
  for (const auto* const offsets : {&table.forward, &table.reverse}) {
    if (const Status s = check_offsets(*offsets, kMostEntries, false, kInt32, units); !s.ok())
      return s;
  }
  if (const Status s = check_nominal(table.nominal, table.forward.size(), kInt32, kPerUnit);
      !s.ok())
    return s;
  text = fmt::format(
      "kopf.log_achs_nr {}\nkopf.log_achs_name {}\nkw.ssfk.interval 0\nkw.ssfk.kw_startpos {}\n"
      "kw.ssfk.kw_nr_max {}\nkw.ssfk.unit 1\nkw.ssfk.bilateral 1\n",
      table.axis_number, table.axis, nearest(table.nominal.front() * kPerUnit),
      table.nominal.size());
  text += column("setpoint", table.nominal, kPerUnit);
  text += column("pos", table.forward, -units);
  text += column("neg", table.reverse, -units);
  return {};
}

}  // namespace volcomp::host
