#include "host_sim/host/bus/setup.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/tables/image.hpp"
#include "firmware/node/cia402_words.hpp"
#include "firmware/node/node_objects.hpp"
#include "firmware/node/object_handles.hpp"
#include "firmware/node/offset_gate.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::NmtState;

namespace {

void check_device(NodeClient& client, SetupResult& result) {
  std::uint32_t product = 0;
  try {
    product = client.read(node::object::product_code);
  } catch (const NodeRefused&) {  // only 1018h:01 is mandatory (CiA 301, 7.5.2.21)
  }
  if (product != node::kProductCode)
    throw UserError(
        fmt::format("node {} is no compensation node: its product code (1018h:02) is "
                    "{:08X}h instead of {:08X}h",
                    client.node_id(), product, node::kProductCode));
  result.device = client.read(node::object::device_name);
}

// A node without heartbeat refuses its settings itself while it runs.
void check_state(NodeClient& client) {
  constexpr std::uint64_t kHeartbeatTimeout_us = 1'000'000;
  const std::optional<NmtState> state = client.await_heartbeat(kHeartbeatTimeout_us);
  refuse_while_following(client, state);
  if (state == NmtState::operational)
    throw UserError(
        fmt::format("node {} is OPERATIONAL: stop the machine first, settings are written "
                    "PRE-OPERATIONAL only",
                    client.node_id()));
  if (state == NmtState::stopped)
    throw UserError(fmt::format(
        "node {} is STOPPED and answers nothing: it has to be PRE-OPERATIONAL", client.node_id()));
}

// The number in the tables that are active; nothing without them, or when another image has been
// staged since.
std::optional<std::uint32_t> machine_of_tables(NodeClient& client) {
  const std::uint32_t crc = active_tables(client).crc;
  if (crc == 0) return {};
  std::vector<std::uint8_t> image;
  try {
    image = fetch_image(client);
  } catch (const NodeRefused&) {  // the staged image was discarded
    return {};
  }
  const Span<const std::uint8_t> bytes{image.data(), image.size()};
  TablesView tables;
  if (image_crc(bytes) != crc || !check_image(bytes, image.size(), tables).ok()) return {};
  return tables.provenance.machine_id;
}

void check_machine(NodeClient& client, const MachineFile& machine) {
  const auto set = client.read(node::object::machine_id);
  if (set != 0 && set != machine.id)
    throw UserError(
        fmt::format("node {} belongs to machine {} (2000h:01), {} is machine {}; 1011h:01 "
                    "makes it a new node",
                    client.node_id(), set, machine.path, machine.id));
  const std::optional<std::uint32_t> held = machine_of_tables(client);
  if (held && *held != machine.id)
    throw UserError(
        fmt::format("node {} has the tables of machine {}, {} is machine {}; 1011h:01 "
                    "makes it a new node",
                    client.node_id(), *held, machine.path, machine.id));
}

// CiA 301, 7.5.2.13: bit 0 of 1010h:01 means that the device saves on command.
void check_store(NodeClient& client) {
  const auto saves = client.read(node::object::store);
  if ((saves & 1U) == 0)
    throw UserError(
        fmt::format("node {} has no store to be written (1010h:01): its settings would be lost "
                    "when its power fails; --no-store writes them all the same",
                    client.node_id()));
}

std::uint64_t read_bits(NodeClient& client, const PlannedValue& value) {
  return number(client.read(value.object, canopen::size_of(value.type), value.name));
}

// Each object once, with the last value that is written to it.
std::vector<SetupValue> last_writes(const SetupPlan& plan) {
  std::vector<SetupValue> values;
  for (auto value = plan.begin(); value != plan.end(); ++value) {
    const auto same = [&](const PlannedValue& other) { return other.object == value->object; };
    if (std::none_of(value + 1, plan.end(), same)) values.push_back({*value, 0, 0});
  }
  return values;
}

// What is not stored has to be known when something fails on the way.
class Writing {
 public:
  Writing(NodeClient& client, const SetupPlan& plan) : client_(client), plan_(plan) {}

  void write_all() {
    for (const PlannedValue& value : plan_) {
      step([&] { client_.write(value.object, value.bytes(), value.name); });
      ++written_;
    }
  }

  template <class Step>
  void step(const Step& step) const {
    try {
      step();
    } catch (const NodeRefused& refused) {
      fail(refused.what());
    } catch (const UserError& error) {
      fail(error.what());
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw UserError(
        fmt::format("{}; nothing was stored, {} of {} values are written and lost at the "
                    "next start of node {}",
                    why, written_, plan_.size(), client_.node_id()));
  }

  NodeClient& client_;
  const SetupPlan& plan_;
  std::size_t written_ = 0;
};

// Which bit of 6041h means referenced stands in the manual of a drive only: bit 8 of some is
// another one. The complete drive without a name has bit 8.
void take_referenced_masks(const MachineFile& machine, BusSettings& settings) {
  for (std::size_t i = 0; i < settings.axes.size(); ++i) {
    const DriveFile& drive = machine.axes[i].drive;
    if (drive.referenced_mask) {
      settings.axes[i].referenced_mask = *drive.referenced_mask;
    } else if (!drive.model.empty()) {
      throw UserError(fmt::format(
          "{}: axis {} needs referenced_mask: which bits of the statusword of {} mean referenced "
          "stands in its manual, and \"none\" is for one that has no such bit",
          machine.path, machine.axes[i].letter, drive.model));
    }
  }
}

}  // namespace

BusSettings setup_bus(const MachineFile& machine, std::optional<double> cycle_hz,
                      std::optional<std::uint8_t> node) {
  if (!machine.bus.stated)
    throw UserError(
        fmt::format("{}: there is no [bus] with node_id, controller_id and cycle_hz, which a real "
                    "bus needs",
                    machine.path));
  if (!cycle_hz) cycle_hz = machine.bus.cycle_hz;
  if (!cycle_hz)
    throw UserError(
        fmt::format("{}: [bus] has no cycle_hz, the rate of SYNC, and there is no "
                    "--cycle-hz",
                    machine.path));
  MachineFile limited = machine;
  limited.correction = machine.correction.with_default_acceleration();
  BusSettings settings = bus_settings(limited, *cycle_hz);
  settings.node = node.value_or(settings.node);
  take_referenced_masks(machine, settings);
  const auto taken = [&](std::uint8_t other, const std::string& who) {
    if (settings.node == other)
      throw UserError(
          fmt::format("{}: node {} is {}, not a compensation node", machine.path, other, who));
  };
  taken(settings.controller, "the controller");
  for (const BusAxis& axis : settings.axes)
    taken(axis.drive, fmt::format("the drive of axis {}", axis.letter));
  return settings;
}

std::vector<OffsetFacts> node_offsets(const MachineFile& machine, const BusSettings& settings) {
  const node::NodeObjects defaults{};
  std::vector<OffsetFacts> facts;
  for (const std::size_t a : axes_with_offsets(machine.chain.description())) {
    OffsetLimits limits = settings.limits.axis.at(a);
    limits.rate = node::OffsetGate::unhindered(limits.rate, defaults.late_cycles);
    limits.soft_rate = std::min(limits.soft_rate, limits.rate);
    facts.push_back(offset_facts(settings.axes.at(a).letter, settings.axes.at(a).rotary, limits,
                                 1e-6 * settings.period_us));
  }
  return facts;
}

void refuse_while_following(NodeClient& client, std::optional<NmtState> state) {
  namespace object = node::object;
  if (state != NmtState::operational) return;
  for (std::size_t axis = 0; axis < node::kNodeAxes; ++axis) {
    const auto way = client.find(object::way[axis]);
    const bool forwarded = way && static_cast<Way>(*way) == Way::forwarded_target &&
                           client.read(object::drive[axis]) != 0;
    if (!forwarded || !node::operation_enabled(client.read(object::drive_status[axis])) ||
        client.read(object::drive_mode[axis]) != node::kCyclicPosition)
      continue;
    throw UserError(fmt::format(
        "axis {} (drive {}) follows targets that node {} forwards and would stop: disable the "
        "drives first",
        axis + 1, client.read(object::drive[axis]), client.node_id()));
  }
}

bool SetupResult::ok() const {
  return std::all_of(values.begin(), values.end(), [](const SetupValue& v) { return v.kept(); });
}

SetupResult set_up(NodeClient& client, const MachineFile& machine, const SetupPlan& plan,
                   const SetupOptions& options) {
  SetupResult result;
  result.node = client.node_id();
  check_state(client);
  check_device(client, result);
  check_machine(client, machine);
  if (options.store) check_store(client);
  result.values = last_writes(plan);
  for (SetupValue& value : result.values)
    value.before = read_bits(client, value.planned);
  Writing writing(client, plan);
  writing.write_all();
  writing.step([&] {
    if (!options.tables.empty()) {
      send_image(client, options.tables);
      activate_tables(client);
      result.tables = active_tables(client);
    }
    for (SetupValue& value : result.values)
      value.after = read_bits(client, value.planned);
    if (options.store && result.ok()) store_all(client);
  });
  result.stored = options.store && result.ok();
  return result;
}

}  // namespace volcomp::host
