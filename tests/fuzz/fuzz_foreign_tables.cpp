// Any bytes as a foreign file: accepted or refused with a UserError. The first byte chooses the
// format.

#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/etalon_text.hpp"
#include "host_sim/host/tables/formats/isg_csv.hpp"
#include "tests/oracle/controller_tables.hpp"

namespace {

using namespace volcomp::host;
using volcomp::test::read_cec;
using volcomp::test::read_enc_comp;
using volcomp::test::read_ssfk;

void check(bool good) {
  if (!good) __builtin_trap();
}

// What is accepted becomes run files that can be read, or is refused as a whole.
void read_errors(void (*read)(std::istream&, const std::string&, ForeignErrors&),
                 const std::string& text) {
  std::istringstream stream(text);
  ForeignErrors errors;
  read(stream, "errors.txt", errors);
  for (const RunsFile& runs : to_runs(errors, "errors.txt", {-1, true})) {
    std::stringstream written;
    write_runs(written, runs);
    try {
      check(read_runs(written, "runs.csv").positions.size() == runs.positions.size());
    } catch (const volcomp::host::UserError&) {
      check(false);
    }
  }
}

void read_any(unsigned format, const std::string& text) {
  switch (format % 6U) {
    case 0: {
      std::istringstream stream(text);
      const LinuxcncComp table = read_linuxcnc(stream, "axis.comp", format < 128 ? 0 : 1);
      check(table.forward.size() == table.nominal.size());
      return;
    }
    case 1: {
      const SsfkTable table = read_ssfk(text, format < 128);
      check(table.reverse.size() == table.nominal.size());
      return;
    }
    case 2:
      check(read_enc_comp(text, format < 128).offset.size() >= 2);
      return;
    case 3:
      check(read_cec(text, format < 128, 1).offset.size() >= 2);
      return;
    case 4:
      return read_errors(read_isg_csv, text);
    default:
      return read_errors(read_etalon, text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read_any(data[0], std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  } catch (const volcomp::host::UserError&) {
    return 0;
  }
  return 0;
}
