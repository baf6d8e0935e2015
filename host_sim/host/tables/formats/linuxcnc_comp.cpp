#include "host_sim/host/tables/formats/linuxcnc_comp.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

double finite(double value, const CsvLines& lines) {
  if (!std::isfinite(value)) lines.fail("a number must be finite");
  return value;
}

void read_entry(const std::vector<std::string_view>& words, const CsvLines& lines,
                LinuxcncComp& table) {
  if (words.size() != 3) lines.fail("expected: nominal forward reverse");
  const double at = finite(lines.number(words[0]), lines);
  const auto trim = [&](std::string_view word) {
    const double value = lines.number(word);
    return finite(table.type == 0 ? at - value : value, lines);
  };
  if (!table.nominal.empty() && !(at > table.nominal.back()))
    lines.fail("nominal positions must ascend");
  table.nominal.push_back(at);
  table.forward.push_back(trim(words[1]));
  table.reverse.push_back(trim(words[2]));
}

}  // namespace

Status write_linuxcnc(const LinuxcncComp& table, std::string& text) {
  Where where;
  where.field = "type";
  if (table.type != 0 && table.type != 1) return refuse(Reason::bad_setting, where);
  if (table.forward.size() != table.reverse.size()) return refuse(Reason::length_mismatch);
  for (const auto* const column : {&table.forward, &table.reverse}) {
    if (const Status s = check_offsets(*column, kLinuxcncEntries, false, kSixDecimals, 1.0);
        !s.ok())
      return s;
  }
  if (const Status s = check_nominal(table.nominal, table.forward.size(), kSixDecimals); !s.ok())
    return s;
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

LinuxcncComp read_linuxcnc(std::istream& stream, const std::string& name, int type) {
  CsvLines lines(stream, name);
  LinuxcncComp table;
  table.type = type;
  std::string row;
  bool ended = false;
  while (lines.any(row)) {
    const std::vector<std::string_view> words = words_of(row);
    if (words.empty()) {
      ended = true;
      continue;
    }
    if (ended) lines.fail("LinuxCNC reads nothing after an empty line");
    if (table.nominal.size() == kLinuxcncEntries)
      lines.fail(fmt::format("more than {} entries", kLinuxcncEntries));
    read_entry(words, lines, table);
  }
  if (table.nominal.size() < 2)
    throw UserError(fmt::format("{}: {} entries; 2 to {} are allowed", name, table.nominal.size(),
                                kLinuxcncEntries));
  return table;
}

}  // namespace volcomp::host
