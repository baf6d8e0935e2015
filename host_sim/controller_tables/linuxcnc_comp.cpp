#include "host_sim/controller_tables/linuxcnc_comp.hpp"

#include <sstream>

#include <fmt/format.h>

#include "comp/tables/interpolation.hpp"
#include "host_sim/controller_tables/text_numbers.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {

Status write_linuxcnc(const LinuxcncComp& table, std::string& text) {
  Where where;
  where.field = "type";
  if (table.type != 0 && table.type != 1) return refuse(Reason::bad_setting, where);
  if (table.forward.size() != table.reverse.size()) return refuse(Reason::length_mismatch);
  for (const auto* const column : {&table.forward, &table.reverse}) {
    if (const Status s = check_offsets(*column, kLinuxcncEntries, false, 1.0); !s.ok()) return s;
  }
  if (const Status s = check_nominal(table.nominal, table.forward.size()); !s.ok()) return s;
  std::string out;
  for (std::size_t k = 0; k < table.nominal.size(); ++k) {
    const double at = table.nominal[k];
    const auto printed = [&](double t) { return six_decimals(table.type == 0 ? at - t : t); };
    out += fmt::format("{} {} {}\n", six_decimals(at), printed(table.forward[k]),
                       printed(table.reverse[k]));
  }
  text = out;
  return {};
}

LinuxcncComp read_linuxcnc(const std::string& text, int type) {
  LinuxcncComp table;
  table.type = type;
  std::istringstream stream(text);
  std::string row;
  bool ended = false;
  for (int line = 1; std::getline(stream, row); ++line) {
    std::istringstream words(row);
    std::string nominal;
    std::string forward;
    std::string reverse;
    std::string more;
    if (!(words >> nominal)) {
      ended = true;
      continue;
    }
    if (ended) throw UserError(at_line(line, "LinuxCNC reads nothing after an empty line"));
    if (table.nominal.size() == kLinuxcncEntries)
      throw UserError(at_line(line, fmt::format("more than {} entries", kLinuxcncEntries)));
    if (!(words >> forward >> reverse) || words >> more)
      throw UserError(at_line(line, "expected: nominal forward reverse"));
    const double at = read_decimal(nominal, line);
    const auto trim = [&](const std::string& word) {
      const double value = read_decimal(word, line);
      return type == 0 ? at - value : value;
    };
    if (!table.nominal.empty() && !(at > table.nominal.back()))
      throw UserError(at_line(line, "nominal positions must ascend"));
    table.nominal.push_back(at);
    table.forward.push_back(trim(forward));
    table.reverse.push_back(trim(reverse));
  }
  if (table.nominal.size() < 2)
    throw UserError(
        fmt::format("{} entries; 2 to {} are allowed", table.nominal.size(), kLinuxcncEntries));
  return table;
}

double offset_at(const LinuxcncComp& table, double position, int travel) {
  const std::vector<double>& t = travel < 0 ? table.reverse : table.forward;
  return interpolate(Interpolation::linear, Ends::hold, table.nominal, t, {}, position);
}

}  // namespace volcomp::sim
