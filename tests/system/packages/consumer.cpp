// A user's program in C++ with comp alone: the servo loop of firmware/embed/cpp/servo_example.cpp,
// and the same fingerprint.
//
//   consumer TABLE_IMAGE

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "comp/tables/image.hpp"
#include "comp/tick/instances.hpp"

namespace {

struct Travel {
  std::int32_t lower;
  std::int32_t upper;
  std::int32_t step;
};
constexpr std::array<Travel, 3> kTravel{
    {{-50'200'000, -100'000, 2200}, {-29'900'000, -100'000, 1300}, {-39'900'000, -100'000, 700}}};

volcomp::XyfzCompensator compensator;

bool commission(const std::vector<std::uint8_t>& image) {
  volcomp::TablesView tables;
  if (!check_image({image.data(), image.size()}, volcomp::kDefaultKnots, tables).ok()) return false;
  volcomp::XyfzCompensator::Settings settings;
  for (volcomp::AxisLimits& axis : settings.axis) {
    axis.limit = 200'000;
    axis.rate = 1'000;
    axis.soft_rate = 100;
    axis.acceleration = 8;
    axis.hysteresis = 2'000;
    axis.max_step = 100'000;
  }
  settings.ramp_ticks = 2'000;
  settings.stale_drop_ticks = 20;
  return compensator.configure(settings).ok() &&
         compensator.stage(tables, tables.chain.tool_point(), 0).ok() &&
         compensator.activate().ok();
}

std::uint32_t fingerprint() {
  std::uint32_t sum = 2166136261U;
  std::array<std::int32_t, 3> count{};
  std::array<bool, 3> upwards{};
  volcomp::XyfzCompensator::Input in;
  volcomp::XyfzCompensator::Output out;
  for (std::uint32_t period = 0; period < 40'000; ++period) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t here = period == 0 ? kTravel[a].upper : count[a];
      if (here <= kTravel[a].lower) upwards[a] = true;
      if (here >= kTravel[a].upper) upwards[a] = false;
      count[a] = here + (upwards[a] ? kTravel[a].step : -kTravel[a].step);
      in.axis[a] = {std::int64_t{10} * count[a], a != 1 || period < 12'000 || period >= 12'050,
                    true};
    }
    compensator.tick(in, out);
    for (std::size_t a = 0; a < 3; ++a) {
      sum = (sum ^ static_cast<std::uint32_t>(out.offset[a])) * 16777619U;
      sum = (sum ^ out.status[a]) * 16777619U;
    }
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!commission({bytes.begin(), bytes.end()})) return 2;
  std::printf("fingerprint of all        0x%08x\n", fingerprint());
  return 0;
}
