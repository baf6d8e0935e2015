#include "host_sim/host/tables/formats/siemens_cec.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
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

}  // namespace volcomp::host
