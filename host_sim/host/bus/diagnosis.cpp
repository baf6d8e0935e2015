#include "host_sim/host/bus/diagnosis.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;

// 2^40 (positions) and 2^32 (offsets, limits) units per turn of a rotary axis.
constexpr double kMicroradPerTurn = 2e6 * 3.14159265358979323846;
constexpr double kPositionUnitsPerTurn = 1099511627776.0;
constexpr double kOffsetUnitsPerTurn = 4294967296.0;
constexpr double kUmPerNm = 1e-3;

constexpr std::uint8_t sub_of(std::size_t axis) { return static_cast<std::uint8_t>(axis + 1); }

AxisDiagnosis diagnose_axis(NodeClient& client, std::size_t axis, const std::string& letters) {
  AxisDiagnosis d;
  d.number = axis + 1;
  d.letter = axis < letters.size() ? letters[axis] : '\0';
  d.drive = client.read(object::drive[axis]);
  if (d.drive == 0) return d;
  d.rotary = client.read(object::rotary[axis]) != 0;
  d.drive_status = client.read(object::drive_status[axis]);
  d.status = client.read(object::status[axis]);
  const std::uint32_t numerator = client.read(object::scale_numerator[axis]);
  const std::uint32_t denominator = client.read(object::scale_denominator[axis]);
  const std::int32_t offset = client.read(object::offset[axis]);
  const std::int32_t largest = client.read(object::largest[axis]);
  d.offset = static_cast<double>(offset) * numerator / denominator *
             (d.rotary ? kMicroradPerTurn / kPositionUnitsPerTurn : kUmPerNm);
  d.largest_offset =
      static_cast<double>(largest) * (d.rotary ? kMicroradPerTurn / kOffsetUnitsPerTurn : kUmPerNm);
  for (std::size_t bit = 0; bit < d.began.size(); ++bit) {
    const auto index = static_cast<std::uint16_t>(0x2610 + axis);
    d.began[bit] = client.read_value<std::uint16_t>({index, sub_of(bit)}, "count of a status");
  }
  return d;
}

void read_identity(NodeClient& client, Diagnosis& d) {
  constexpr std::uint64_t kHeartbeatPatience_us = 1'000'000;
  d.name = client.read_text({0x1008, 0}, 24, "device name");
  d.hardware_version = client.read_text({0x1009, 0}, 8, "hardware version");
  d.software_version = client.read_text({0x100A, 0}, 8, "software version");
  d.nmt = client.await_heartbeat(kHeartbeatPatience_us);
}

void read_errors(NodeClient& client, Diagnosis& d) {
  d.error_register = client.read_value<std::uint8_t>({0x1001, 0}, "error register");
  const auto count = client.read_value<std::uint8_t>({0x1003, 0}, "number of errors");
  for (unsigned i = 1; i <= count; ++i) {
    d.errors.push_back(
        client.read_value<std::uint32_t>({0x1003, static_cast<std::uint8_t>(i)}, "error field"));
  }
}

void read_tables(NodeClient& client, Diagnosis& d) {
  d.state = client.read<node::NodeState>(object::state);
  d.table_state = client.read<node::TableState>(object::table_state);
  d.tables = active_tables(client);
  d.machine_id = client.read(object::machine_id);
  d.refusal = refusal(client);
}

void read_counters(NodeClient& client, Diagnosis& d) {
  d.cycles = client.read(object::cycles);
  d.deadline_missed = client.read(object::deadline_missed);
  d.cycles_skipped = client.read(object::cycles_skipped);
  d.sync_missed = client.read(object::sync_missed);
  d.sync_foreign = client.read(object::sync_foreign);
  d.activations = client.read(object::activations);
  d.rejections = client.read(object::rejections);
  d.stored = client.read<node::StoreResult>(object::stored);
  d.saved = client.read<node::StoreResult>(object::store_result);
  d.start = client.read<hal::ResetCause>(object::reset_cause);
  d.frames_lost = client.read(object::frames_lost);
}

}  // namespace

Diagnosis diagnose(NodeClient& client) {
  Diagnosis d;
  d.node_id = client.node_id();
  read_identity(client, d);
  read_errors(client, d);
  read_tables(client, d);
  read_counters(client, d);
  const std::string letters = d.tables.crc == 0
                                  ? std::string()
                                  : client.read_text(object::axis_letters.id(), 8, "axis letters");
  for (std::size_t axis = 0; axis < node::kNodeAxes; ++axis) {
    const AxisDiagnosis a = diagnose_axis(client, axis, letters);
    if (a.drive != 0) d.axes.push_back(a);
  }
  d.strokes = diagnose_strokes(client);
  d.thermal = diagnose_thermal(client);
  return d;
}

}  // namespace volcomp::host
