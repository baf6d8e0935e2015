// Any bytes as a table of observations, of every kind, over a machine of three linear axes and one
// with two rotary axes: accepted or refused with a UserError, and what is accepted is complete and
// finite.

#include <array>
#include <cmath>
#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/observation_table.hpp"

namespace {

using namespace volcomp::host;
using identify::ObservationKind;
using identify::TableRow;

constexpr std::array<ObservationKind, 7> kTables{ObservationKind::tracer,   ObservationKind::bar,
                                                 ObservationKind::diagonal, ObservationKind::step,
                                                 ObservationKind::rtest,    ObservationKind::centre,
                                                 ObservationKind::touch};

std::size_t readings_of(ObservationKind kind) {
  if (kind == ObservationKind::rtest) return 3;
  return kind == ObservationKind::centre || kind == ObservationKind::touch ? 0 : 1;
}

void check(const TableRow& row, std::size_t axes, std::size_t readings) {
  if (row.value.size() != readings) __builtin_trap();
  for (const double value : row.value)
    if (!std::isfinite(value)) __builtin_trap();
  for (std::size_t a = 0; a < row.q.size(); ++a) {
    const double q = row.q.at(a);
    const double d = row.d.at(a);
    if (!std::isfinite(q) || std::abs(d) > 1.0 || std::abs(d - std::round(d)) > 0.0)
      __builtin_trap();
    if (a >= axes && (std::abs(q) > 0.0 || std::abs(d) > 0.0)) __builtin_trap();
  }
}

void read(const std::string& text, const MachineFile& machine, ObservationKind kind) {
  std::istringstream stream(text);
  try {
    const auto table = identify::read_observation_table(stream, "table.csv", machine, kind);
    if (table.rows.empty() || table.rows.size() > identify::kMostObservations) __builtin_trap();
    const std::size_t readings = table.has_readings ? readings_of(kind) : 0;
    std::size_t line = 0;
    for (const TableRow& row : table.rows) {
      if (row.line <= line) __builtin_trap();
      line = row.line;
      check(row, machine.axes.size(), readings);
    }
  } catch (const UserError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<MachineFile, 2> machines{read_machine_file(bundled_machine("xyfz")),
                                                   read_machine_file(bundled_machine("trunnion"))};
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const MachineFile& machine : machines)
    for (const ObservationKind kind : kTables)
      read(text, machine, kind);
  return 0;
}
