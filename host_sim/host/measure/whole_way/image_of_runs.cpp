#include "host_sim/host/measure/whole_way/image_of_runs.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/tables/image.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// Another compiler may round the last bit of a table elsewhere: less than these is the same.
constexpr double kSame_nm = 0.1;
constexpr double kSame_rad = 1e-10;

bool same_grid(const TableGrid& a, const TableGrid& b) {
  return a.q0 == b.q0 && a.pitch == b.pitch && a.knots == b.knots && a.periodic == b.periodic;
}

struct Difference {
  double nm = 0.0;
  double rad = 0.0;
};

Difference largest_difference(const AxisTable& a, const AxisTable& b) {
  Difference most;
  for (std::size_t d = 0; d < a.value.size(); ++d) {
    for (std::size_t i = 0; i < a.knots; ++i) {
      for (std::size_t c = 0; c < kChannels.size(); ++c) {
        const double difference = std::abs(static_cast<double>(a.value.at(d).at(i).at(c)) -
                                           static_cast<double>(b.value.at(d).at(i).at(c)));
        double& largest = c < 3 ? most.nm : most.rad;
        largest = std::max(largest, difference);
      }
    }
  }
  return most;
}

[[noreturn]] void refuse_image(const TableImage& image, const std::string& what) {
  throw UserError(
      fmt::format("{}: not made from these runs: {}; other runs, another machine file, or other "
                  "--slope or --knots",
                  image.name, what));
}

double direction_difference(const MachineTables& a, const MachineTables& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.directions.size(); ++k)
    most = std::max(most, (a.directions[k] - b.directions[k]).cwiseAbs().maxCoeff());
  return most;
}

}  // namespace

void require_image_of_runs(const TableImage& image, const MachineFile& machine,
                           const BuiltTables& built) {
  const MachineTables& of_image = *image.tables;
  require_same_machine(of_image, image.name, machine);
  const std::vector<std::uint8_t> bytes = make_image(built.tables);
  const auto of_runs = std::make_unique<MachineTables>();
  require(decode_image({bytes.data(), bytes.size()}, kTableKnots, *of_runs), image.name);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const char letter = machine.axes[a].letter;
    const AxisTable& there = of_image.axis.at(a);
    const AxisTable& here = of_runs->axis.at(a);
    if (!same_grid(there, here))
      refuse_image(image, fmt::format("the table of axis {} has {} knots, they make {}", letter,
                                      there.knots, here.knots));
    const Difference d = largest_difference(there, here);
    if (d.nm > kSame_nm || d.rad > kSame_rad)
      refuse_image(image,
                   fmt::format("the tables of axis {} differ by up to {:.4g} um and {:.4g} urad",
                               letter, d.nm / kUmPerMm, 1e6 * d.rad));
  }
  if (const double d = direction_difference(of_image, *of_runs); d > kSame_rad)
    refuse_image(image, fmt::format("the squareness differs by {:.4g} urad", 1e6 * d));
}

}  // namespace volcomp::host
