#include "comp/metrology/tables/iso230.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcomp {
namespace {

struct Range {
  double lo = std::numeric_limits<double>::infinity();
  double hi = -std::numeric_limits<double>::infinity();

  void include(double value) {
    lo = std::min(lo, value);
    hi = std::max(hi, value);
  }
  [[nodiscard]] double width() const { return hi - lo; }
};

}  // namespace

Status iso230_figures(const DirectionStatistics& up, const DirectionStatistics& down,
                      Iso230Figures& out) {
  const std::size_t n = up.mean.size();
  if (n == 0 || down.mean.size() != n || up.deviation.size() != n || down.deviation.size() != n) {
    return refuse(Reason::too_few_points);
  }
  Iso230Figures f;
  Range all;
  Range rising;
  Range falling;
  Range means;
  Range mean_of_both;
  for (std::size_t i = 0; i < n; ++i) {
    const double su = up.deviation[i];
    const double sd = down.deviation[i];
    const double reversal = up.mean[i] - down.mean[i];
    f.R_up = std::max(f.R_up, 4.0 * su);
    f.R_down = std::max(f.R_down, 4.0 * sd);
    f.R = std::max({f.R, 2.0 * su + 2.0 * sd + std::abs(reversal), 4.0 * su, 4.0 * sd});
    f.B = std::max(f.B, std::abs(reversal));
    rising.include(up.mean[i] - 2.0 * su);
    rising.include(up.mean[i] + 2.0 * su);
    falling.include(down.mean[i] - 2.0 * sd);
    falling.include(down.mean[i] + 2.0 * sd);
    means.include(up.mean[i]);
    means.include(down.mean[i]);
    mean_of_both.include(0.5 * (up.mean[i] + down.mean[i]));
  }
  all = rising;
  all.include(falling.lo);
  all.include(falling.hi);
  f.A = all.width();
  f.A_up = rising.width();
  f.A_down = falling.width();
  f.E = means.width();
  f.M = mean_of_both.width();
  out = f;
  return {};
}

}  // namespace volcomp
