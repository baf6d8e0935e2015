#pragma once
// A compensation node is set up for its machine: everything that the machine file determines is
// written while the node is PRE-OPERATIONAL, read back and stored.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/host/bus/setup_plan.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/machine/offset_facts.hpp"

namespace volcomp::host {

// How the machine is wired to a real bus. `cycle_hz` and `node` take precedence over the file.
// Throws UserError when the file has no [bus] or no cycle rate, when an axis names its drive but
// not what bits of 6041h mean referenced (2033h), or when two devices would have one
// node id: on a real bus a wrong default of any of them moves axes wrongly. Offsets whose
// acceleration the file does not state get the default.
[[nodiscard]] BusSettings setup_bus(const MachineFile& machine, std::optional<double> cycle_hz,
                                    std::optional<std::uint8_t> node);

// What limits the offsets of the axes in the node: a correction has only a part of 2202h.
[[nodiscard]] std::vector<OffsetFacts> node_offsets(const MachineFile& machine,
                                                    const BusSettings& settings);

// One object and its value after the last of its writes.
struct SetupValue {
  PlannedValue planned;
  std::uint64_t before = 0;
  std::uint64_t after = 0;

  [[nodiscard]] bool differed() const { return before != planned.bits; }
  [[nodiscard]] bool kept() const { return after == planned.bits; }
};

struct SetupOptions {
  bool store = true;                 // 1010h:01
  std::vector<std::uint8_t> tables;  // image to activate before that; empty: none
};

struct SetupResult {
  std::uint8_t node = 0;
  std::string device;  // 1008h
  std::vector<SetupValue> values;
  std::optional<ActiveTables> tables;  // those of the options
  bool stored = false;

  // Every object holds what was written; nothing is stored otherwise.
  [[nodiscard]] bool ok() const;
};

// For what takes the node out of OPERATIONAL: an axis whose targets it forwards stops then. Throws
// UserError with the axis when one follows (2034h = 1, its drive enabled in mode 8). `state`: as
// heard; nothing is read unless the node is OPERATIONAL, as the objects are old otherwise.
void refuse_while_following(NodeClient& client, std::optional<canopen::NmtState> state);

// Throws UserError or NodeRefused when the node is none of volcomp, runs, belongs to another
// machine or cannot store what it should: nothing has been written then. Throws UserError when the
// node refuses a value or stops answering: the text names the object, counts the writes so far and
// states that nothing was stored.
[[nodiscard]] SetupResult set_up(NodeClient& client, const MachineFile& machine,
                                 const SetupPlan& plan, const SetupOptions& options);

// The plan and the result for people and for programs.
[[nodiscard]] std::string describe(const SetupPlan& plan);
[[nodiscard]] std::string describe(const SetupResult& result);
[[nodiscard]] nlohmann::json to_json(const SetupPlan& plan);
[[nodiscard]] nlohmann::json to_json(const SetupResult& result);

}  // namespace volcomp::host
