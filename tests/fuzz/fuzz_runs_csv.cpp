// Any bytes as a run file: accepted or refused with a UserError, and what is accepted survives
// writing and reading.

#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

using volcomp::host::RunsFile;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  RunsFile runs;
  try {
    runs = volcomp::host::read_runs(stream, "runs.csv");
  } catch (const volcomp::host::UserError&) {
    return 0;
  }
  for (const auto& run : runs.up) {
    if (run.size() != runs.positions.size()) __builtin_trap();
  }
  std::stringstream written;
  volcomp::host::write_runs(written, runs);
  const RunsFile again = volcomp::host::read_runs(written, "written.csv");
  if (again.up.size() != runs.up.size() || again.down.size() != runs.down.size()) __builtin_trap();
  return 0;
}
