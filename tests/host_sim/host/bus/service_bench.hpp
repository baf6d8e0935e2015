#pragma once
// One compensation node and one service tool on a simulated bus; every frame is written down.

#include <memory>
#include <string>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/controller/simulated_bus.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::host {

// Tables of the machine that comes with the program, measured without noise.
struct KnownMachine {
  KnownMachine()
      : file(read_machine_file(bundled_machine("xyfz"))),
        truth(sim::draw_machine(file, 1)),
        campaign(sim::perfect_campaign(truth, file)),
        tables(build_tables(campaign.machine, campaign.runs, {})->tables),
        image(make_image(tables)) {}

  MachineFile file;
  sim::TrueMachine truth;
  sim::Campaign campaign;
  MachineTables tables;
  std::vector<std::uint8_t> image;
};

inline const KnownMachine& known_machine() {
  static const KnownMachine machine;
  return machine;
}

// Everything the bus carries, as text.
inline void record(sim::SimulatedBus& bus, std::string& log) {
  bus.bus().set_observer([&log](std::uint64_t time_ns, const hal::CanFrame& frame,
                                const hal::LoopbackBus::Port& /*sender*/) {
    log += log_line(time_ns / 1000U, "loopback", frame) + "\n";
  });
}

class ServiceBench {
 public:
  explicit ServiceBench(node::Storage* storage = nullptr, bool with_node = true)
      : node(std::make_unique<node::Node>(kNodeId, storage)), client(kNodeId, [this](NodeClient&) {
          pass_us(1000);
          return bus.now_us();
        }) {
    record(bus, log);
    if (with_node) bus.attach(node->device(), "node");
    bus.attach(client, "tool");
    node->power_on(0);
  }

  void pass_us(std::uint64_t us) { bus.run_until(bus.bus().now_ns() + 1000U * us); }
  // From a third participant, which does not listen.
  void send(const hal::CanFrame& frame) {
    controller.send(frame);
    pass_us(1000);
  }
  void write(canopen::ObjectId object, SdoChannel::Bytes value) {
    client.write(object, std::move(value), "test");
  }

  static constexpr std::uint8_t kNodeId = 32;

  std::string log;
  sim::SimulatedBus bus;
  std::unique_ptr<node::Node> node;
  NodeClient client;
  sim::SimulatedBus::Port& controller =
      bus.attach_served("controller", [](sim::SimulatedBus::Port&, std::uint64_t) {});
};

}  // namespace volcomp::host
