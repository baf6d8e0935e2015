#include "host_sim/host/measure/intervals/run_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace volcomp::host {
namespace {

using Runs = std::vector<std::vector<double>>;

struct Direction {
  const char* name;
  const Runs& runs;
};

Status missing(const char* field) {
  Where where;
  where.field = field;
  return refuse(Reason::missing_field, where);
}

Status check_shape(const Direction& d, std::size_t targets) {
  Where where;
  where.direction = d.name;
  if (d.runs.size() < 2) {
    where.count = static_cast<int>(d.runs.size());
    return refuse(Reason::too_few_runs, where);
  }
  for (std::size_t r = 0; r < d.runs.size(); ++r) {
    if (d.runs[r].size() == targets) continue;
    where.run = static_cast<int>(r);
    return refuse(Reason::run_length, where);
  }
  return {};
}

Status check_finite(const std::vector<double>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (std::isfinite(positions[i])) continue;
    Where where;
    where.field = "positions";
    where.index = static_cast<int>(i);
    return refuse(Reason::not_finite, where);
  }
  return {};
}

Status check_finite(const Direction& d) {
  for (std::size_t r = 0; r < d.runs.size(); ++r) {
    for (std::size_t t = 0; t < d.runs[r].size(); ++t) {
      if (std::isfinite(d.runs[r][t])) continue;
      Where where;
      where.direction = d.name;
      where.run = static_cast<int>(r);
      where.target = static_cast<int>(t);
      return refuse(Reason::not_finite, where);
    }
  }
  return {};
}

Status check_positions(const std::vector<double>& positions) {
  Where where;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    if (positions[i] > positions[i - 1]) continue;
    where.index = static_cast<int>(i);
    return refuse(Reason::positions_not_monotone, where);
  }
  if (positions.size() >= 2) return {};
  where.count = static_cast<int>(positions.size());
  return refuse(Reason::too_few_points, where);
}

// How run r differs from the first, up and down one after the other.
std::vector<double> difference(const Runs& up, const Runs& down, std::size_t r) {
  std::vector<double> out;
  for (const Runs* runs : {&up, &down}) {
    for (std::size_t t = 0; t < runs->front().size(); ++t)
      out.push_back((*runs)[r][t] - (*runs)[0][t]);
  }
  return out;
}

// What is below the rounding of the readings is no spread.
bool spread_shows(const Runs& up, const Runs& down) {
  constexpr double kRounding = 1e-12;
  double largest = 0.0;
  for (const Runs* runs : {&up, &down}) {
    for (const std::vector<double>& run : *runs) {
      for (const double value : run)
        largest = std::max(largest, std::abs(value));
    }
  }
  for (std::size_t r = 1; r < up.size(); ++r) {
    const std::vector<double> d = difference(up, down, r);
    const auto [least, most] = std::minmax_element(d.begin(), d.end());
    if (*most - *least > kRounding * largest) return true;
  }
  return false;
}

}  // namespace

Status check_runs(const std::vector<double>& positions, const Runs& up, const Runs& down) {
  if (positions.empty()) return missing("positions");
  if (up.empty()) return missing("up");
  if (down.empty()) return missing("down");
  const std::array<Direction, 2> directions{{{"up", up}, {"down", down}}};
  for (const Direction& d : directions) {
    const Status status = check_shape(d, positions.size());
    if (!status.ok()) return status;
  }
  if (const Status status = check_finite(positions); !status.ok()) return status;
  for (const Direction& d : directions) {
    const Status status = check_finite(d);
    if (!status.ok()) return status;
  }
  if (up.size() != down.size()) return refuse(Reason::run_count_differs);
  if (const Status status = check_positions(positions); !status.ok()) return status;
  return spread_shows(up, down) ? Status() : refuse(Reason::no_spread);
}

}  // namespace volcomp::host
