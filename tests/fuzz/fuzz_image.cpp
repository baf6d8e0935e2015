// Any bytes as a table image: once as they are, once with length and checksum repaired so that the
// checks behind them are reached. Numbers are mutated as numbers. What is accepted must survive a
// round trip and must be safe to stage and to run: no output beyond its limit, none faster than its
// rate.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "comp/tables/image.hpp"
#include "comp/tick/instances.hpp"
#include "tests/oracle/hostile_image.hpp"

namespace volcomp {
namespace {

using Bytes = std::vector<std::uint8_t>;

void require(bool condition) {
  if (!condition) std::abort();
}

void repair(Bytes& bytes) { test::HostileImage(bytes.data(), bytes.size()).repair(); }

void round_trip(const MachineTables& tables) {
  Bytes once(image_size(tables));
  std::size_t written = 0;
  require(encode_image(tables, once, written).ok() && written == once.size());
  const auto again = std::make_unique<MachineTables>();
  require(decode_image({once.data(), once.size()}, kTableKnots, *again).ok());
  Bytes twice(image_size(*again));
  require(encode_image(*again, twice, written).ok() && twice == once);
}

void run(const MachineTables& tables) {
  constexpr std::int32_t kLimit = 12'000;  // three steps: an offset that runs away gets beyond it
  constexpr std::int32_t kRate = 5'000;
  const RuntimeChain chain = make_runtime_chain(tables.machine);
  if (chain.axes > OrientingCompensator::kAxes) return;
  const auto compensator = std::make_unique<OrientingCompensator>(OrientingMachine{chain});
  OrientingCompensator::Settings settings;
  for (AxisLimits& l : settings.axis) {
    l.limit = kLimit;
    l.rate = kRate;
  }
  settings.ramp_ticks = 3;
  require(compensator->configure(settings).ok());
  const Vec3 tool(tables.machine.tool_point[0], tables.machine.tool_point[1],
                  tables.machine.tool_point[2]);
  if (!compensator->stage(tables, tool, 0).ok()) return;
  require(compensator->activate().ok());
  OrientingCompensator::Input in;
  OrientingCompensator::Output out;
  std::array<std::int32_t, OrientingCompensator::kAxes> last{};
  for (int n = 0; n < 64; ++n) {
    for (std::size_t a = 0; a < chain.axes; ++a) {
      const AxisTable& t = tables.axis[a];
      const std::int64_t places[] = {t.q0,
                                     t.q0 - 1,
                                     t.last(),
                                     t.last() + 1,
                                     t.q0 + t.pitch,
                                     t.q0 + t.pitch - 1,
                                     0,
                                     std::numeric_limits<std::int64_t>::min(),
                                     std::numeric_limits<std::int64_t>::max()};
      in.axis[a].position = places[(static_cast<std::size_t>(n) * (a + 1)) % 9];
      in.axis[a].valid = n % 13 != 5;
      in.axis[a].homed = n % 29 != 7;
    }
    compensator->tick(in, out);
    for (std::size_t a = 0; a < chain.axes; ++a) {
      require(std::abs(out.offset[a]) <= kLimit);
      require(std::abs(out.offset[a] - last[a]) <= kRate);
      last[a] = out.offset[a];
    }
  }
}

void decode_and_use(const Bytes& bytes) {
  const auto tables = std::make_unique<MachineTables>();
  if (!decode_image({bytes.data(), bytes.size()}, kTableKnots, *tables).ok()) return;
  round_trip(*tables);
  run(*tables);
}

}  // namespace
}  // namespace volcomp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  volcomp::Bytes bytes(data, data + size);
  volcomp::decode_and_use(bytes);
  volcomp::repair(bytes);
  volcomp::decode_and_use(bytes);
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed);

// Bytes as bytes every fourth time, else numbers as numbers with the checksums repaired.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  std::mt19937_64 bits(seed);
  volcomp::test::HostileImage(data, size).mutate(bits);
  return size;
}
