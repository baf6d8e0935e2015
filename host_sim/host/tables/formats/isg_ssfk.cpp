#include "host_sim/host/tables/formats/isg_ssfk.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/interpolation.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMostEntries = 1500;
constexpr double kPerUnit = 1e4;  // of 0.1 µm in a mm, of 0.0001 degree in a degree
constexpr const char* kTable = "kw.ssfk.table[";

double file_units(bool rotary) { return kPerUnit * (rotary ? 180.0 / kPi : 1.0); }

// The lines of a file by key.
class Entries {
 public:
  explicit Entries(const std::string& text) {
    std::istringstream stream(text);
    std::string row;
    for (int line = 1; std::getline(stream, row); ++line) {
      std::istringstream words(row);
      std::string key;
      std::string value;
      std::string more;
      if (!(words >> key)) continue;
      if (!(words >> value) || words >> more) throw UserError(at_line(line, "expected: key value"));
      if (!lines_.emplace(key, Line{value, line}).second)
        throw UserError(at_line(line, printable(key) + " is there twice"));
    }
  }

  [[nodiscard]] std::string text(const std::string& key) const { return at(key).value; }
  [[nodiscard]] long long integer(const std::string& key) const {
    return read_integer(at(key).value, at(key).number);
  }
  void expect(const std::string& key, long long wanted) const {
    if (integer(key) != wanted)
      throw UserError(at_line(at(key).number, fmt::format("only {} {} is supported", key, wanted)));
  }

 private:
  struct Line {
    std::string value;
    int number = 0;
  };
  [[nodiscard]] const Line& at(const std::string& key) const {
    const auto found = lines_.find(key);
    if (found == lines_.end()) throw UserError(key + " is missing");
    return found->second;
  }

  std::map<std::string, Line> lines_;
};

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

SsfkTable read_ssfk(const std::string& text, bool rotary) {
  const Entries entries(text);
  entries.expect("kw.ssfk.interval", 0);
  entries.expect("kw.ssfk.unit", 1);
  entries.expect("kw.ssfk.bilateral", 1);
  SsfkTable table;
  table.rotary = rotary;
  table.axis_number = static_cast<int>(entries.integer("kopf.log_achs_nr"));
  table.axis = entries.text("kopf.log_achs_name");
  const long long count = entries.integer("kw.ssfk.kw_nr_max");
  if (count < 2 || count > static_cast<long long>(kMostEntries))
    throw UserError(fmt::format("kw.ssfk.kw_nr_max {}: 2 to {} are allowed", count, kMostEntries));
  for (long long k = 0; k < count; ++k) {
    const auto value = [&](const char* name, double units) {
      const long long entry = entries.integer(fmt::format("{}{}].{}", kTable, k, name));
      return static_cast<double>(entry) / units;
    };
    table.nominal.push_back(value("setpoint", kPerUnit));
    table.forward.push_back(value("pos", -file_units(rotary)));
    table.reverse.push_back(value("neg", -file_units(rotary)));
  }
  const std::vector<double>& at = table.nominal;
  if (std::adjacent_find(at.begin(), at.end(), std::greater_equal<>()) != at.end())
    throw UserError("setpoints must ascend");
  return table;
}

double offset_at(const SsfkTable& table, double position, int travel) {
  const std::vector<double>& t = travel < 0 ? table.reverse : table.forward;
  return interpolate(Interpolation::linear, Ends::hold, table.nominal, t, {}, position);
}

}  // namespace volcomp::host
