// Prints how far the axes leave a circle after the node has died, and how far an axis jumps that is
// enabled without the node: the tables of docs/drives.md.
//
//   volcomp_node_death [STRIDE]
//
// The node dies in every STRIDE-th cycle of a turn (16 unless given; 1 takes half an hour).

#include <algorithm>
#include <cstdlib>
#include <exception>

#include <fmt/format.h>

#include "tests/system/forwarded/node_death.hpp"
#include "tests/system/forwarded/old_target.hpp"

namespace {

using namespace volcomp::sim;
using Missing = DriveBehaviour::MissingTarget;

double worst_mm(const NodeDeath& death, int stride) {
  double worst = 0.0;
  for (int cycle = 0; cycle < death_cycles(death.feed_m_per_s); cycle += stride)
    worst = std::max(worst, path_error_mm(death, cycle));
  return worst;
}

// Places along the turn are as far apart at any feed.
void print_row(const char* name, DeathWatch watch, int stride) {
  std::string row = fmt::format("| {} |", name);
  for (const bool both : {true, false}) {
    for (const double feed : {0.1, 1.0}) {
      std::string cell;
      for (const Missing missing : {Missing::held, Missing::extrapolated, Missing::fault}) {
        const int every = feed < 0.5 ? 10 * stride : stride;
        const double error = worst_mm({watch, missing, both, feed}, every);
        cell += fmt::format("{}{:.{}f}", cell.empty() ? " " : " / ", error, error < 0.1 ? 3 : 1);
      }
      row += cell + " |";
    }
  }
  fmt::print("{}\n", row);
}

void print_jumps() {
  fmt::print("mm; old target {} mm away, 6065h = 1 mm\n", kMovedByHand_mm);
  fmt::print("| axis | 6066h = 0 | 10 ms |\n");
  for (const double acceleration : {0.0, 10'000.0}) {
    std::string row = acceleration > 0.0 ? fmt::format("| {} mm/s2 |", acceleration) : "| any |";
    for (const std::uint16_t timeout_ms : {std::uint16_t{0}, std::uint16_t{10}}) {
      OldTarget way;
      way.careless = true;
      way.following_timeout_ms = timeout_ms;
      way.most_acceleration_mm_per_s2 = acceleration;
      row += fmt::format(" {:.2f} |", enable_with_old_target(way).moved_mm);
    }
    fmt::print("{}\n", row);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    print_jumps();
    const int stride = argc > 1 ? static_cast<int>(std::strtol(argv[1], nullptr, 10)) : 16;
    fmt::print("mm; circle of {} mm, {} m/s2; target held / extrapolated / a fault\n",
               kDeathRadius_mm, 1e-9 * kDeathDeceleration);
    fmt::print("| who notices | both forwarded, 0.1 m/s | 1 m/s | X alone, 0.1 m/s | 1 m/s |\n");
    print_row("nobody dies", DeathWatch::nobody, std::max(stride, 1));
    print_row("controller", DeathWatch::controller, std::max(stride, 1));
    print_row("RPDO timer", DeathWatch::rpdo_timer, std::max(stride, 1));
    print_row("heartbeat", DeathWatch::heartbeat, std::max(stride, 1));
  } catch (const std::exception& e) {
    fmt::print(stderr, "volcomp_node_death: {}\n", e.what());
    return 1;
  }
  return 0;
}
