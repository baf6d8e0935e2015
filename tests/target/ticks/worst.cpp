// Looks for the most expensive tick of every machine: instructions, least and most by kind.
//
//   toolchain/run-firmware m7 worst
//
// One line per figure, a word and fields name=value:
//   worst machine=… kind=everyday|limited|change|anything count=… min=… max=…   instructions
//   digest machine=… acceleration=unbounded|bounded outputs=… counts=…
// The call of the tick with its arguments is included; what reading the counter costs is not.
//
// Exit code 1 when the counter cannot be trusted, tables are refused, or a digest is another one.

#include "tests/target/text.hpp"
#include "tests/target/ticks/cost.hpp"
#include "tests/target/ticks/worst_run.hpp"

namespace volcomp::target {
namespace {

bool same_everywhere = true;

class InstructionMeter {
 public:
  InstructionMeter() {
    const std::uint32_t start = InstructionCounter::ticks();
    reading_ = counter.between(start, InstructionCounter::ticks());
  }
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static)
  [[gnu::always_inline]] std::uint32_t start() { return InstructionCounter::ticks(); }
  [[gnu::always_inline]] std::uint32_t stop(std::uint32_t start) const {
    const std::uint32_t now = InstructionCounter::ticks();
    return counter.between(start, now) - reading_;
  }

 private:
  std::uint32_t reading_;  // what one reading costs
};

void print(const char* machine, const WorstCost& cost) {
  for (std::size_t kind = 0; kind < kTickKindNames.size(); ++kind) {
    const WorstCost::Entry& entry = cost.of(kind);
    if (entry.count == 0) continue;
    put("worst");
    put_field("machine", machine);
    put_field("kind", kTickKindNames[kind]);
    put_field("count", entry.count);
    put_field("min", entry.least);
    put_field("max", entry.most);
    put('\n');
  }
}

void print(const char* machine, const char* acceleration, const SearchDigest& digest) {
  put("digest");
  put_field("machine", machine);
  put_field("acceleration", acceleration);
  put_field("outputs", digest.outputs);
  put_field("counts", digest.counts);
  put('\n');
}

void measure_all() {
  InstructionMeter meter;
  visit_worst_machines([&meter](const WorstMachine& machine, const auto& unit,
                                const MachineDescription& description) {
    const Searched searched = look_for_the_worst(*unit, description, meter);
    print(machine.name, searched.cost);
    print(machine.name, "unbounded", searched.digests.unbounded);
    print(machine.name, "bounded", searched.digests.bounded);
    same_everywhere = same_everywhere && searched.digests == machine.digests;
  });
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  counter.start();
  measure_all();
  if (!counter.exact())
    stop("The counter does not count instructions: start QEMU with -icount shift=6,sleep=off.");
  if (!same_everywhere) stop("Offsets, status words or errors are not those of the other boards.");
  return 0;
}
