#include "comp/strokes/learning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcomp {
namespace {

double clamped(double value, double most) { return std::min(std::max(value, -most), most); }

bool enough(const LearningRules& rules, const NodeSums& node) {
  return node.n > 0 && node.n >= rules.least_samples;
}

// One update under way.
class Update {
 public:
  Update(const LearningRules& rules, Span<const NodeSums> nodes, Span<double> table,
         Span<double> smoothed)
      : rules_(rules), nodes_(nodes), table_(table), smoothed_(smoothed) {}

  [[nodiscard]] bool finite() const {
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      if (!std::isfinite(table_[j]) || !std::isfinite(nodes_[j].sum) ||
          !std::isfinite(nodes_[j].sum_squares))
        return false;
    }
    return true;
  }

  // y_j = Σ h v m / Σ h v over the taps inside the table.
  [[nodiscard]] double smooth(std::size_t j) const {
    const Kernel kernel = at(j);
    return kernel.counts() ? kernel.sum / kernel.weight : 0.0;
  }

  // Whether the node moves: it has a y, and y is beyond its dead band.
  [[nodiscard]] bool moves(std::size_t j) const {
    if (!at(j).counts()) return false;
    const NodeSums& node = nodes_[j];
    const double m = mean(node);
    const auto n = static_cast<double>(node.n);
    const double variance = std::max(node.sum_squares / n - m * m, 0.0);
    return !(std::abs(smoothed_[j]) < rules_.dead_sigma * std::sqrt(variance / n));
  }

  // What the node becomes.
  [[nodiscard]] double next(std::size_t j) const {
    if (!moves(j)) return table_[j];
    const double step = clamped(rules_.weight * smoothed_[j], rules_.most_step);
    return clamped(table_[j] - step, rules_.most_offset);
  }

  [[nodiscard]] bool too_steep() const {
    const double most = rules_.most_slope * rules_.spacing * (1.0 + 1e-12);
    const std::size_t n = table_.size();
    const std::size_t pairs = rules_.periodic ? n : n - 1;
    for (std::size_t j = 0; j < pairs; ++j) {
      if (std::abs(next((j + 1) % n) - next(j)) > most) return true;
    }
    return false;
  }

 private:
  // The smoothing kernel on one node.
  struct Kernel {
    double sum = 0.0;     // Σ h v m
    double weight = 0.0;  // Σ h v

    [[nodiscard]] bool counts() const { return weight >= 0.5 - 1e-12; }
  };

  [[nodiscard]] bool valid(const NodeSums& node) const { return enough(rules_, node); }
  static double mean(const NodeSums& node) { return node.sum / static_cast<double>(node.n); }

  // The node under tap k when the middle tap is on j; nullptr beyond the ends.
  [[nodiscard]] const NodeSums* neighbour(std::size_t j, std::size_t k) const {
    const std::size_t half = rules_.tap_count / 2;
    const std::size_t n = nodes_.size();
    if (rules_.periodic) return &nodes_[(j + k + n * kMostTaps - half) % n];
    if (j + k < half || j + k - half >= n) return nullptr;
    return &nodes_[j + k - half];
  }

  // Without weight where the node itself is not valid.
  [[nodiscard]] Kernel at(std::size_t j) const {
    Kernel kernel;
    if (!valid(nodes_[j])) return kernel;
    for (std::size_t k = 0; k < rules_.tap_count; ++k) {
      const NodeSums* const node = neighbour(j, k);
      if (node == nullptr || !valid(*node)) continue;
      kernel.sum += rules_.taps[k] * mean(*node);
      kernel.weight += rules_.taps[k];
    }
    return kernel;
  }

  const LearningRules& rules_;
  Span<const NodeSums> nodes_;
  Span<double> table_;
  Span<double> smoothed_;
};

Status check_number(const char* field, double value, bool allowed) {
  Where where;
  where.field = field;
  where.value = value;
  where.has_value = true;
  if (!std::isfinite(value)) return refuse(Reason::not_finite, where);
  return allowed ? Status{} : refuse(Reason::bad_setting, where);
}

}  // namespace

Status check_rules(const LearningRules& rules) {
  struct Field {
    const char* name;
    double value;
    bool allowed;
  };
  const std::array<Field, 6> fields{{{"weight", rules.weight, rules.weight > 0.0},
                                     {"dead_sigma", rules.dead_sigma, rules.dead_sigma >= 0.0},
                                     {"most_step", rules.most_step, rules.most_step > 0.0},
                                     {"most_offset", rules.most_offset, rules.most_offset > 0.0},
                                     {"most_slope", rules.most_slope, rules.most_slope > 0.0},
                                     {"spacing", rules.spacing, rules.spacing > 0.0}}};
  for (const Field& field : fields) {
    if (const Status s = check_number(field.name, field.value, field.allowed); !s.ok()) return s;
  }
  const auto count = static_cast<double>(rules.tap_count);
  const bool odd = rules.tap_count % 2 == 1 && rules.tap_count <= kMostTaps;
  if (const Status s = check_number("tap_count", count, odd); !s.ok()) return s;
  double sum = 0.0;
  for (std::size_t k = 0; k < rules.tap_count; ++k) {
    if (const Status s = check_number("taps", rules.taps[k], rules.taps[k] >= 0.0); !s.ok())
      return s;
    sum += rules.taps[k];
  }
  return check_number("taps", sum, std::abs(sum - 1.0) < 1e-9);
}

LearningReport learning_update(const LearningRules& rules, Span<const NodeSums> nodes,
                               Span<double> table, Span<double> smoothed) {
  const Update update(rules, nodes, table, smoothed);
  LearningReport report;
  std::fill(smoothed.begin(), smoothed.end(), 0.0);
  if (!update.finite()) {
    report.result = LearningResult::nonfinite;
    return report;
  }
  if (!any_node_valid(rules, nodes)) {
    report.result = LearningResult::nodata;
    return report;
  }
  for (std::size_t j = 0; j < table.size(); ++j)
    smoothed[j] = update.smooth(j);
  if (update.too_steep()) {
    report.result = LearningResult::slope;
    return report;
  }
  for (std::size_t j = 0; j < table.size(); ++j) {
    if (!update.moves(j)) {
      ++report.skipped;
      continue;
    }
    table[j] = update.next(j);
    ++report.updated;
    if (!(std::abs(table[j]) < rules.most_offset)) ++report.clamped;
  }
  return report;
}

bool any_node_valid(const LearningRules& rules, Span<const NodeSums> nodes) {
  return std::any_of(nodes.begin(), nodes.end(),
                     [&rules](const NodeSums& node) { return enough(rules, node); });
}

double rms_of_means(const LearningRules& rules, Span<const NodeSums> nodes) {
  double squares = 0.0;
  double count = 0.0;
  for (const NodeSums& node : nodes) {
    if (!enough(rules, node)) continue;
    const double mean = node.sum / static_cast<double>(node.n);
    squares += mean * mean;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

double uniform_table_value(Span<const double> values, double q0, double h, bool periodic,
                           double q) {
  const std::size_t n = values.size();
  double place = (q - q0) / h;
  if (periodic) {
    const auto period = static_cast<double>(n);
    place -= period * std::floor(place / period);
  } else {
    place = std::min(std::max(place, 0.0), static_cast<double>(n - 1));
  }
  const auto below = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(below);
  const double a = values[below % n];
  const double b = values[periodic ? (below + 1) % n : std::min(below + 1, n - 1)];
  return a + t * (b - a);
}

}  // namespace volcomp
