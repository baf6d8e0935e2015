#include "host_sim/host/tables/formats/siemens_enc_comp.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
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

}  // namespace volcomp::host
