#pragma once
// Where the compensation of a scenario is done, and what that takes while the scenario runs.

#include <memory>
#include <string>
#include <vector>

#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/sim/boards/emulated_node.hpp"
#include "host_sim/sim/controller/bus_recorder.hpp"

namespace volcomp::cli {

struct NodePlace {
  std::string can;          // loopback or a link; empty: integrated, or firmware
  FirmwareChoice firmware;  // instead of `can`, or joined to it by a CAN controller of its own
  std::string log_file;     // empty: none
  std::vector<std::string>
      drives;  // data sheets: one for all axes or one for each; none: as the file says
  double cycle_hz = sim::kBusCycle_hz;

  [[nodiscard]] bool integrated() const { return can.empty() && !firmware.chosen(); }
};

// For people: "CAN vcan0, 500 Hz, lock step".
[[nodiscard]] std::string describe(const NodePlace& place);
// How many knots a table may have for the node there.
[[nodiscard]] std::size_t knots_at(const NodePlace& place);

// Not for the integrated form. Every function throws UserError.
class ScenarioBus {
 public:
  // `watch`, if any, sees every cycle of every machine; it must outlive them.
  explicit ScenarioBus(const NodePlace& place, sim::MachineWatch* watch = nullptr);

  // Does the work; adds the last output of the firmware to the message of an error.
  template <class Work>
  auto watch(Work&& work) {
    return board_ ? board_->with_last_words(work) : work();
  }
  // The bus must outlive what is made.
  [[nodiscard]] sim::BusAxesFactory axes();
  [[nodiscard]] sim::CellFactory cells(const host::MachineFile& machine) {
    return sim::bus_cells(machine, cycle_hz_, axes());
  }
  // The machine is switched off: a node elsewhere goes back to PRE-OPERATIONAL, where it waits for
  // the next controller and service tools may store what it has.
  void switch_off();
  // After the scenario: the log is complete, the firmware has ended well.
  void finish();

 private:
  void join(const NodePlace& place);

  double cycle_hz_;
  std::vector<std::string> drives_;
  sim::MachineWatch* watch_;
  std::unique_ptr<sim::EmulatedNode> board_;
  std::unique_ptr<host::FrameLink> opened_;
  host::FrameLink* link_ = nullptr;  // to a node that is not in this process
  std::unique_ptr<sim::CanGateway> gateway_;
  std::unique_ptr<host::CanLogWriter> log_;
  std::unique_ptr<sim::BusRecorder> recorder_;
};

}  // namespace volcomp::cli
