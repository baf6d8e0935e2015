#include "host_sim/host/tables/formats/siemens_enc_comp.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/strokes/learning.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/siemens_text.hpp"
#include "host_sim/host/tables/formats/text_numbers.hpp"

namespace volcomp::host {
namespace {

constexpr const char* kHeader = "%_N_AX_EEC_INI";
constexpr std::size_t kMostEntries = 5000;

double file_units(bool rotary) { return rotary ? 180.0 / kPi : 1.0; }

}  // namespace

Status write_enc_comp(const EncCompTable& table, std::string& text) {
  const double units = file_units(table.rotary);
  Where where;
  where.field = "axis";
  if (table.axis.empty()) return refuse(Reason::bad_setting, where);
  where.field = "step";
  if (!(table.step > 0.0)) return refuse(Reason::bad_setting, where);
  where.field = "min";
  if (!fits_extent(table.min, table.step, table.offset.size()))
    return refuse(Reason::bad_setting, where);
  if (const Status s = check_offsets(table.offset, kMostEntries, table.modulo, kSixDecimals, units);
      !s.ok())
    return s;
  std::string out = fmt::format("{}\nCHANDATA(1)\n", kHeader);
  for (std::size_t k = 0; k < table.offset.size(); ++k)
    out += fmt::format("$AA_ENC_COMP[0,{},{}]={}\n", k, table.axis,
                       six_decimals(-table.offset[k] * units));
  const double max = table.min + table.step * static_cast<double>(table.offset.size() - 1);
  out += fmt::format("$AA_ENC_COMP_STEP[0,{}]={}\n", table.axis, six_decimals(table.step));
  out += fmt::format("$AA_ENC_COMP_MIN[0,{}]={}\n", table.axis, six_decimals(table.min));
  out += fmt::format("$AA_ENC_COMP_MAX[0,{}]={}\n", table.axis, six_decimals(max));
  out += fmt::format("$AA_ENC_COMP_IS_MODULO[0,{}]={}\nM17\n", table.axis, table.modulo ? 1 : 0);
  text = out;
  return {};
}

EncCompTable read_enc_comp(const std::string& text, bool rotary) {
  EncCompTable table;
  table.rotary = rotary;
  table.step = 0.0;
  std::map<long long, double> entries;
  double max = 0.0;
  for (const SystemVariable& v : read_system_variables(text, kHeader)) {
    const bool entry = v.name == "AA_ENC_COMP";
    if (v.index.size() != (entry ? 3U : 2U) || v.index[0] != "0")
      throw UserError(at_line(v.line, "expected an index of measuring system 0"));
    if (!table.axis.empty() && v.index.back() != table.axis)
      throw UserError(at_line(v.line, "another axis than before"));
    table.axis = v.index.back();
    if (entry) {
      const long long k = read_integer(v.index[1], v.line);
      if (!entries.emplace(k, -read_decimal(v.value, v.line) / file_units(rotary)).second)
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

}  // namespace volcomp::host
