#include "tests/oracle/controller_tables.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/interpolation.hpp"
#include "comp/strokes/learning.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::test {
namespace {

using host::CecTable;
using host::EncCompTable;
using host::LinuxcncComp;
using host::SsfkTable;
using host::UserError;

double per_unit(bool rotary) { return rotary ? 180.0 / kPi : 1.0; }

// --- numbers

std::string printable(const std::string& text) {
  std::string out = text.substr(0, 40);
  for (char& c : out)
    c = (c >= ' ' && c <= '~') ? c : '?';
  return out;
}

std::string at_line(int line, const std::string& complaint) {
  return fmt::format("line {}: {}", line, complaint);
}

template <class Number>
Number read_all(const std::string& text, int line, const char* kind) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end)
    throw UserError(at_line(line, fmt::format("'{}' is not {}", printable(text), kind)));
  return value;
}

double read_decimal(const std::string& text, int line) {
  const auto value = read_all<double>(text, line, "a number");
  if (!std::isfinite(value)) throw UserError(at_line(line, "a number must be finite"));
  return value;
}

long long read_integer(const std::string& text, int line) {
  return read_all<long long>(text, line, "an integer");
}

// --- the frame of Siemens files: a header, assignments to system variables, M17

// $NAME[index,…]=value, without the $; parentheses around the value are taken off.
struct SystemVariable {
  std::string name;
  std::vector<std::string> index;
  std::string value;
  int line = 0;
};

// The next line without the carriage return of files that come from a control.
bool next_line(std::istream& stream, std::string& row) {
  if (!std::getline(stream, row)) return false;
  if (!row.empty() && row.back() == '\r') row.pop_back();
  return true;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);)
    parts.push_back(part);
  return parts;
}

SystemVariable read_assignment(const std::string& text, int line) {
  const std::size_t open = text.find('[');
  const std::size_t close = text.find("]=");
  if (text.front() != '$' || open == std::string::npos || close == std::string::npos ||
      close < open)
    throw UserError(at_line(line, "expected $NAME[index]=value"));
  SystemVariable variable;
  variable.line = line;
  variable.name = text.substr(1, open - 1);
  variable.index = split(text.substr(open + 1, close - open - 1), ',');
  variable.value = text.substr(close + 2);
  const std::string& value = variable.value;
  if (value.size() > 2 && value.front() == '(' && value.back() == ')')
    variable.value = value.substr(1, value.size() - 2);
  return variable;
}

// All between `header`, CHANDATA(1) and M17.
std::vector<SystemVariable> read_system_variables(const std::string& text,
                                                  const std::string& header) {
  std::vector<SystemVariable> variables;
  std::istringstream stream(text);
  std::string row;
  int line = 0;
  for (const std::string& wanted : {header, std::string("CHANDATA(1)")}) {
    ++line;
    if (!next_line(stream, row) || row != wanted)
      throw UserError(at_line(line, "expected " + wanted));
  }
  while (next_line(stream, row)) {
    ++line;
    if (row == "M17") return variables;
    if (!row.empty()) variables.push_back(read_assignment(row, line));
  }
  throw UserError(at_line(line, "the file ends without M17"));
}

// The entries of a table, which must be complete: 0, 1, 2, … without gap or repetition.
std::vector<double> complete_entries(const std::map<long long, double>& entries,
                                     const std::string& name) {
  std::vector<double> values;
  for (const auto& [index, value] : entries) {
    if (index != static_cast<long long>(values.size()))
      throw UserError(fmt::format("{}: entry {} is missing", name, values.size()));
    values.push_back(value);
  }
  return values;
}

// MIN, MAX and STEP of a table agree with its number of entries.
void check_extent(double min, double max, double step, std::size_t entries) {
  constexpr double kRounding = 2e-6;  // six decimals
  const double wanted = min + step * (static_cast<double>(entries) - 1.0);
  if (entries < 2 || !(step > 0.0) ||
      std::abs(max - wanted) > kRounding * static_cast<double>(entries))
    throw UserError(
        fmt::format("MIN {}, MAX {} and STEP {} do not fit {} entries", min, max, step, entries));
}

// One assignment of the file to the table.
class Reader {
 public:
  explicit Reader(CecTable& table) : table_(table) {}

  void take(const SystemVariable& v) {
    const bool entry = v.name == "AN_CEC";
    if (v.index.size() != (entry ? 2U : 1U))
      throw UserError(at_line(v.line, "wrong number of indices"));
    const auto number = static_cast<int>(read_integer(v.index[0], v.line));
    if (started_ && number != table_.number)
      throw UserError(at_line(v.line, "another table than before"));
    started_ = true;
    table_.number = number;
    if (entry) return take_entry(v);
    if (v.name == "AN_CEC_INPUT_AXIS") {
      table_.input = v.value;
    } else if (v.name == "AN_CEC_OUTPUT_AXIS") {
      table_.output = v.value;
    } else {
      take_number(v);
    }
  }

  void finish() {
    table_.offset = complete_entries(entries_, "$AN_CEC");
    check_extent(table_.min, max_, table_.step, table_.offset.size());
    if (table_.input.empty() || table_.output.empty())
      throw UserError("the input or the output axis is missing");
  }

 private:
  void take_entry(const SystemVariable& v) {
    const double value = read_decimal(v.value, v.line) / (per_unit(table_.rotary) * table_.sign);
    if (!entries_.emplace(read_integer(v.index[1], v.line), value).second)
      throw UserError(at_line(v.line, "an entry is there twice"));
  }

  void take_number(const SystemVariable& v) {
    if (v.name == "AN_CEC_STEP") {
      table_.step = read_decimal(v.value, v.line);
    } else if (v.name == "AN_CEC_MIN") {
      table_.min = read_decimal(v.value, v.line);
    } else if (v.name == "AN_CEC_MAX") {
      max_ = read_decimal(v.value, v.line);
    } else if (v.name == "AN_CEC_DIRECTION") {
      table_.direction = static_cast<int>(read_integer(v.value, v.line));
    } else if (v.name == "AN_CEC_IS_MODULO") {
      table_.modulo = read_integer(v.value, v.line) != 0;
    } else if (v.name == "AN_CEC_MULT_BY_TABLE") {
      check_product(v);
    } else {
      throw UserError(at_line(v.line, "unknown variable " + printable(v.name)));
    }
  }

  static void check_product(const SystemVariable& v) {
    if (read_integer(v.value, v.line) != 0)
      throw UserError(at_line(v.line, "products of tables are not supported"));
  }

  CecTable& table_;
  std::map<long long, double> entries_;
  double max_ = 0.0;
  bool started_ = false;
};

// --- kw.ssfk

constexpr long long kMostEntries = 1500;
constexpr double kPerUnit = 1e4;  // of 0.1 µm in a mm, of 0.0001 degree in a degree

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

}  // namespace

EncCompTable read_enc_comp(const std::string& text, bool rotary) {
  EncCompTable table;
  table.rotary = rotary;
  table.step = 0.0;
  std::map<long long, double> entries;
  double max = 0.0;
  for (const SystemVariable& v : read_system_variables(text, "%_N_AX_EEC_INI")) {
    const bool entry = v.name == "AA_ENC_COMP";
    if (v.index.size() != (entry ? 3U : 2U) || v.index[0] != "0")
      throw UserError(at_line(v.line, "expected an index of measuring system 0"));
    if (!table.axis.empty() && v.index.back() != table.axis)
      throw UserError(at_line(v.line, "another axis than before"));
    table.axis = v.index.back();
    if (entry) {
      const long long k = read_integer(v.index[1], v.line);
      if (!entries.emplace(k, -read_decimal(v.value, v.line) / per_unit(rotary)).second)
        throw UserError(at_line(v.line, "an entry is there twice"));
    } else if (v.name == "AA_ENC_COMP_STEP") {
      table.step = read_decimal(v.value, v.line);
    } else if (v.name == "AA_ENC_COMP_MIN") {
      table.min = read_decimal(v.value, v.line);
    } else if (v.name == "AA_ENC_COMP_MAX") {
      max = read_decimal(v.value, v.line);
    } else if (v.name == "AA_ENC_COMP_IS_MODULO") {
      table.modulo = read_integer(v.value, v.line) != 0;
    } else {
      throw UserError(at_line(v.line, "unknown variable " + printable(v.name)));
    }
  }
  table.offset = complete_entries(entries, "$AA_ENC_COMP");
  check_extent(table.min, max, table.step, table.offset.size());
  return table;
}

double offset_at(const EncCompTable& table, double position) {
  // A table that wraps repeats its first value at the end.
  const std::size_t n = table.offset.size() - (table.modulo ? 1U : 0U);
  return uniform_table_value({table.offset.data(), n}, table.min, table.step, table.modulo,
                             position);
}

CecTable read_cec(const std::string& text, bool rotary, int sign) {
  CecTable table;
  table.rotary = rotary;
  table.sign = sign;
  table.step = 0.0;
  Reader reader(table);
  for (const SystemVariable& v : read_system_variables(text, "%_N_NC_CEC_INI"))
    reader.take(v);
  reader.finish();
  return table;
}

double offset_at(const CecTable& table, double position, int travel) {
  if (table.direction * travel < 0) return 0.0;
  const std::size_t n = table.offset.size() - (table.modulo ? 1U : 0U);
  return uniform_table_value({table.offset.data(), n}, table.min, table.step, table.modulo,
                             position);
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
  if (count < 2 || count > kMostEntries)
    throw UserError(fmt::format("kw.ssfk.kw_nr_max {}: 2 to {} are allowed", count, kMostEntries));
  for (long long k = 0; k < count; ++k) {
    const auto value = [&](const char* name, double units) {
      const long long entry = entries.integer(fmt::format("kw.ssfk.table[{}].{}", k, name));
      return static_cast<double>(entry) / units;
    };
    table.nominal.push_back(value("setpoint", kPerUnit));
    table.forward.push_back(value("pos", -kPerUnit * per_unit(rotary)));
    table.reverse.push_back(value("neg", -kPerUnit * per_unit(rotary)));
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

double offset_at(const LinuxcncComp& table, double position, int travel) {
  const std::vector<double>& t = travel < 0 ? table.reverse : table.forward;
  return interpolate(Interpolation::linear, Ends::hold, table.nominal, t, {}, position);
}

}  // namespace volcomp::test
