// The machine on the bus for a very long time: no drift, no growth, nothing lost.
//
//   volcomp_soak [--cycles 10000000]        10^7 cycles are five and a half hours of machine time

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>
#include <set>
#include <string_view>

#include <malloc.h>

#include <fmt/format.h>

#include "tests/system/bus_world.hpp"

namespace {

// Bytes of the objects alive. The count of the C library includes its own caches of freed blocks.
std::size_t live_bytes = 0;

}  // namespace

void* operator new(std::size_t size) {
  void* const block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  live_bytes += ::malloc_usable_size(block);
  return block;
}

void operator delete(void* block) noexcept {
  live_bytes -= ::malloc_usable_size(block);
  std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept { ::operator delete(block); }

namespace volcomp::sim {
namespace {

constexpr std::uint64_t kCheckEvery = 1'000'000;

bool complain(bool fine, const std::string& what) {
  if (!fine) fmt::print(stderr, "bus_soak: {}\n", what);
  return fine;
}

using Ports = std::set<const hal::LoopbackBus::Port*>;

// The ports that receive something.
Ports participants(BusWorld& world) {
  Ports ports;
  world.bus().set_fault_hook([&ports](const hal::CanFrame&, const hal::LoopbackBus::Port&,
                                      const hal::LoopbackBus::Port& receiver) {
    ports.insert(&receiver);
    return hal::LoopbackBus::Fate{};
  });
  world.run(1);
  world.bus().set_fault_hook({});
  return ports;
}

bool nothing_lost(const Ports& ports) {
  return std::all_of(ports.begin(), ports.end(), [](const hal::LoopbackBus::Port* port) {
    return complain(port->counters().overrun == 0, port->name() + " has lost frames") &&
           complain(port->waiting() == 0, port->name() + " has not read its frames");
  });
}

bool counters_agree(const BusWorld& world, std::uint64_t cycles_before) {
  const node::NodeObjects& o = world.node();
  const std::uint64_t cycles = world.cycles() - cycles_before;
  return complain(o.deadline_missed == 0 && o.cycles_skipped == 0, "cycles were incomplete") &&
         complain(o.cycles == cycles, fmt::format("computed {} cycles of {}", o.cycles, cycles));
}

// What must not change.
struct Baseline {
  Ports ports;
  host::Offsets offsets{};
  std::uint64_t cycles_before = 0;  // the node counted its first
  std::size_t heap_bytes = 0;
};

// The same place from the same side: the same offsets, the same memory, every counter in order.
bool check(BusWorld& world, const Baseline& expected) {
  const bool arrived = world.approach();
  const std::size_t heap = live_bytes;
  return complain(arrived, "does not arrive: " + world.trouble()) &&
         complain(heap == expected.heap_bytes,
                  fmt::format("heap {} bytes, was {}", heap, expected.heap_bytes)) &&
         complain(world.trouble().empty(), world.trouble()) &&
         complain(world.violation().empty(), world.violation()) &&
         complain(world.emergencies().empty(), "emergencies" + world.emergencies()) &&
         complain(world.offsets() == expected.offsets, "the offsets have drifted") &&
         nothing_lost(expected.ports) && counters_agree(world, expected.cycles_before);
}

int run(std::uint64_t cycles) {
  BusWorld world(6);
  Baseline baseline;
  baseline.ports = participants(world);
  world.run(static_cast<int>(kCheckEvery / 100));
  if (!complain(world.approach(), world.trouble())) return EXIT_FAILURE;
  world.mark();
  baseline.offsets = world.offsets();
  baseline.cycles_before = world.cycles() - world.node().cycles;
  baseline.heap_bytes = live_bytes;
  const std::uint64_t first = world.cycles();
  const auto begin = std::chrono::steady_clock::now();
  while (world.cycles() - first < cycles) {
    const std::uint64_t rest = cycles - (world.cycles() - first);
    world.run(static_cast<int>(std::min(rest, kCheckEvery)));
    if (!check(world, baseline)) return EXIT_FAILURE;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const auto done = static_cast<double>(world.cycles() - first);
  fmt::print("{:.0f} cycles in {:.1f} s: {:.0f} cycles/s, largest step {} nm, heap {} bytes\n",
             done, took.count(), done / took.count(), world.largest_step(), live_bytes);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace volcomp::sim

int main(int argc, char** argv) {
  std::uint64_t cycles = 10'000'000;
  if (argc == 3 && std::string_view(argv[1]) == "--cycles") {
    cycles = std::strtoull(argv[2], nullptr, 10);
  } else if (argc != 1) {
    fmt::print(stderr, "usage: {} [--cycles N]\n", argv[0]);
    return EXIT_FAILURE;
  }
  return volcomp::sim::run(cycles);
}
