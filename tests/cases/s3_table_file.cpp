// Cases of docs/papers/internal-helical.md: tables of controllers, to the letter; read back and
// written again.

#include <sstream>

#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"
#include "tests/oracle/controller_tables.hpp"

namespace volcomp::cases {
namespace {

std::string enc_comp(const json& in) {
  const host::EncCompTable table{in.at("axis"),         numbers(in.at("t")), number(in.at("min")),
                                 number(in.at("step")), in.at("modulo"),     in.at("rotary")};
  std::string text;
  require(host::write_enc_comp(table, text));
  require(host::write_enc_comp(test::read_enc_comp(text, table.rotary), text));
  return text;
}

std::string cec(const json& in) {
  const host::CecTable table{in.at("table"),      in.at("input"),       in.at("output"),
                             numbers(in.at("t")), number(in.at("min")), number(in.at("step")),
                             in.at("direction"),  in.at("modulo"),      in.at("rotary"),
                             in.at("sign")};
  std::string text;
  require(host::write_cec(table, text));
  require(host::write_cec(test::read_cec(text, table.rotary, table.sign), text));
  return text;
}

std::string linuxcnc(const json& in) {
  const host::LinuxcncComp table{in.at("type"), numbers(in.at("nominal")), numbers(in.at("fwd")),
                                 numbers(in.at("rev"))};
  std::string text;
  require(host::write_linuxcnc(table, text));
  std::istringstream written(text);
  require(host::write_linuxcnc(host::read_linuxcnc(written, "written", table.type), text));
  return text;
}

std::string ssfk(const json& in) {
  const host::SsfkTable table{in.at("log_axis"),         in.at("name"),
                              numbers(in.at("nominal")), numbers(in.at("fwd")),
                              numbers(in.at("rev")),     in.at("rotary")};
  std::string text;
  require(host::write_ssfk(table, text));
  require(host::write_ssfk(test::read_ssfk(text, table.rotary), text));
  return text;
}

json table_file(const json& in) {
  const std::string format = in.at("format");
  if (format == "siemens_enc_comp") return {{"text", enc_comp(in)}};
  if (format == "siemens_cec") return {{"text", cec(in)}};
  if (format == "linuxcnc") return {{"text", linuxcnc(in)}};
  return {{"text", ssfk(in)}};
}

}  // namespace

void add_s3_table_file(Handlers& handlers) { handlers["s3.table_file"] = table_file; }

}  // namespace volcomp::cases
