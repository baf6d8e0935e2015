#include "host_sim/host/bus/diagnosis.hpp"

namespace volcomp::host {
namespace {

// 2^40 (positions) and 2^32 (offsets, limits) units per turn of a rotary axis.
constexpr double kMicroradPerTurn = 2e6 * 3.14159265358979323846;
constexpr double kPositionUnitsPerTurn = 1099511627776.0;
constexpr double kOffsetUnitsPerTurn = 4294967296.0;
constexpr double kUmPerNm = 1e-3;

constexpr std::uint8_t sub_of(std::size_t axis) { return static_cast<std::uint8_t>(axis + 1); }

AxisDiagnosis diagnose_axis(NodeClient& client, std::size_t axis, const std::string& letters) {
  const std::uint8_t sub = sub_of(axis);
  AxisDiagnosis d;
  d.number = axis + 1;
  d.letter = axis < letters.size() ? letters[axis] : '\0';
  d.drive = client.read_value<std::uint8_t>({0x2010, sub}, "drive of an axis");
  if (d.drive == 0) return d;
  d.rotary = client.read_value<std::uint8_t>({0x2032, sub}, "kind of axis") != 0;
  d.drive_status = client.read_value<std::uint16_t>({0x2014, sub}, "status word of a drive");
  d.status = client.read_value<std::uint16_t>({0x2601, sub}, "status of an axis");
  const auto numerator = client.read_value<std::uint32_t>({0x2030, sub}, "scale numerator");
  const auto denominator = client.read_value<std::uint32_t>({0x2031, sub}, "scale denominator");
  const auto offset = client.read_value<std::int32_t>({0x2020, sub}, "offset of an axis");
  const auto largest = client.read_value<std::int32_t>({0x2602, sub}, "largest offset");
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
  d.state = static_cast<node::NodeState>(
      client.read_value<std::uint8_t>({0x2600, 1}, "state of the node"));
  d.table_state = static_cast<node::TableState>(
      client.read_value<std::uint8_t>(node::table_verdict(1), "state of the tables"));
  d.tables = active_tables(client);
  d.machine_id = client.read_value<std::uint32_t>({0x2000, 1}, "machine id");
  d.refusal = refusal(client);
}

void read_counters(NodeClient& client, Diagnosis& d) {
  const auto counter = [&client](std::uint8_t sub) {
    return client.read_value<std::uint32_t>({0x2600, sub}, "counter");
  };
  d.cycles = counter(4);
  d.deadline_missed = counter(5);
  d.cycles_skipped = counter(6);
  d.sync_missed = counter(7);
  d.sync_foreign = counter(8);
  d.activations = counter(9);
  d.rejections = counter(10);
  d.stored = static_cast<node::StoreResult>(
      client.read_value<std::uint8_t>({0x2600, 11}, "result of reading the store"));
  d.saved = static_cast<node::StoreResult>(
      client.read_value<std::uint8_t>({0x2600, 12}, "result of the last save"));
  d.start = static_cast<hal::ResetCause>(
      client.read_value<std::uint8_t>({0x2600, 13}, "reason of the start"));
  d.frames_lost = counter(14);
}

}  // namespace

Diagnosis diagnose(NodeClient& client) {
  Diagnosis d;
  d.node_id = client.node_id();
  read_identity(client, d);
  read_errors(client, d);
  read_tables(client, d);
  read_counters(client, d);
  const std::string letters =
      d.tables.crc == 0 ? std::string() : client.read_text({0x2000, 5}, 8, "axis letters");
  for (std::size_t axis = 0; axis < node::kNodeAxes; ++axis) {
    const AxisDiagnosis a = diagnose_axis(client, axis, letters);
    if (a.drive != 0) d.axes.push_back(a);
  }
  d.strokes = diagnose_strokes(client);
  d.thermal = diagnose_thermal(client);
  return d;
}

}  // namespace volcomp::host
