#include "host_sim/host/tables/formats/siemens_text.hpp"

#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

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

}  // namespace

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

bool fits_extent(double min, double step, std::size_t entries) {
  const double max = min + step * static_cast<double>(entries);
  return std::abs(min) <= kSixDecimals.most && std::abs(max) <= kSixDecimals.most;
}

void check_extent(double min, double max, double step, std::size_t entries) {
  constexpr double kRounding = 2e-6;  // six decimals
  const double wanted = min + step * (static_cast<double>(entries) - 1.0);
  if (entries < 2 || !(step > 0.0) ||
      std::abs(max - wanted) > kRounding * static_cast<double>(entries))
    throw UserError(
        fmt::format("MIN {}, MAX {} and STEP {} do not fit {} entries", min, max, step, entries));
}

}  // namespace volcomp::host
