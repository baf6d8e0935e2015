#include "host_sim/host/tables/formats/siemens_cec.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/strokes/learning.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/siemens_text.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

constexpr const char* kHeader = "%_N_NC_CEC_INI";
constexpr std::size_t kMostEntries = 2000;

double file_units(const CecTable& table) { return (table.rotary ? 180.0 / kPi : 1.0) * table.sign; }

Status check(const CecTable& table) {
  Where where;
  if (table.number < 0) where.field = "number";
  if (table.input.empty()) where.field = "input";
  if (table.output.empty()) where.field = "output";
  if (!(table.step > 0.0)) where.field = "step";
  if (!fits_extent(table.min, table.step, table.offset.size())) where.field = "min";
  if (table.direction < -1 || table.direction > 1) where.field = "direction";
  if (table.sign != 1 && table.sign != -1) where.field = "sign";
  if (where.field != nullptr) return refuse(Reason::bad_setting, where);
  return check_offsets(table.offset, kMostEntries, table.modulo, kSixDecimals, file_units(table));
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
    const double value = read_decimal(v.value, v.line) / file_units(table_);
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

}  // namespace

Status write_cec(const CecTable& table, std::string& text) {
  if (const Status s = check(table); !s.ok()) return s;
  const int t = table.number;
  const double max = table.min + table.step * static_cast<double>(table.offset.size() - 1);
  std::string out = fmt::format("{}\nCHANDATA(1)\n", kHeader);
  for (std::size_t k = 0; k < table.offset.size(); ++k)
    out +=
        fmt::format("$AN_CEC[{},{}]={}\n", t, k, six_decimals(table.offset[k] * file_units(table)));
  out += fmt::format("$AN_CEC_INPUT_AXIS[{}]=({})\n", t, table.input);
  out += fmt::format("$AN_CEC_OUTPUT_AXIS[{}]=({})\n", t, table.output);
  out += fmt::format("$AN_CEC_STEP[{}]={}\n", t, six_decimals(table.step));
  out += fmt::format("$AN_CEC_MIN[{}]={}\n", t, six_decimals(table.min));
  out += fmt::format("$AN_CEC_MAX[{}]={}\n", t, six_decimals(max));
  out += fmt::format("$AN_CEC_DIRECTION[{}]={}\n", t, table.direction);
  out += fmt::format("$AN_CEC_MULT_BY_TABLE[{}]=0\n", t);
  out += fmt::format("$AN_CEC_IS_MODULO[{}]={}\nM17\n", t, table.modulo ? 1 : 0);
  text = out;
  return {};
}

CecTable read_cec(const std::string& text, bool rotary, int sign) {
  CecTable table;
  table.rotary = rotary;
  table.sign = sign;
  table.step = 0.0;
  Reader reader(table);
  for (const SystemVariable& v : read_system_variables(text, kHeader))
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

}  // namespace volcomp::host
