#include "host_sim/host/measure/intervals/positioning_interval.hpp"

#include <cmath>
#include <functional>
#include <iterator>

#include "host_sim/host/measure/intervals/run_check.hpp"

namespace volcomp::host {
namespace {

std::vector<double> list(const Columns& v) { return {std::begin(v), std::end(v)}; }

Columns joined(const Columns& a, const Columns& b) {
  Columns out(a.size() + b.size());
  out[std::slice(0, a.size(), 1)] = a;
  out[std::slice(a.size(), b.size(), 1)] = b;
  return out;
}

Columns root_of_squares(const Columns& a, const Columns& b) { return std::sqrt(a * a + b * b); }

// Of the standard deviations σ̂, from how well the shape of the spread is known.
Columns u_of_sigma(const Columns& sigma, const RunSpread& spread) {
  Columns u(sigma.size());
  for (std::size_t k = 0; k < u.size(); ++k) {
    const Eigen::Vector3d& row = spread.shape[k];
    u[k] = 0.5 * sigma[k] * std::sqrt(row.dot(spread.covariance * row));
  }
  return u;
}

class PositioningFigures {
 public:
  PositioningFigures(const RunReadings& readings, const StatedErrors& stated, std::uint64_t seed,
                     std::size_t draws)
      : spread_(run_spread(readings)),
        up_(0, readings.position.size(), 1),
        down_(readings.position.size(), readings.position.size(), 1),
        mean_(readings.mean()),
        u_(std::sqrt(spread_.v / static_cast<double>(readings.run.size()))) {
    const RunDraws source(readings, spread_, stated, seed, draws);
    spread_.run = source.shared();
    sigma_ = std::sqrt(spread_.v_total());
    u_sigma_ = u_of_sigma(sigma_, spread_);
    stated_ = source.anything_stated();
    for (std::size_t k = 0; k < draws; ++k)
      draw_.push_back(source.draw(k));
  }

  [[nodiscard]] FigureInterval E() const {
    return span([](const Columns& x) { return x; }, u_, false);
  }
  [[nodiscard]] FigureInterval M() const {
    const auto of_both = [this](const Columns& x) -> Columns {
      return 0.5 * (Columns(x[up_]) + Columns(x[down_]));
    };
    return span(of_both, 0.5 * u_reversal(), false);
  }
  [[nodiscard]] FigureInterval A() const {
    return span([](const Columns& x) { return x; }, root_of_squares(u_, 2.0 * u_sigma_), true);
  }
  [[nodiscard]] FigureInterval B() const {
    return norm([this](const Columns& means) { return reversal(means); }, u_reversal());
  }
  [[nodiscard]] FigureInterval R() const;
  [[nodiscard]] FigureInterval largest() const;
  [[nodiscard]] bool runs_differ() const { return spread_.run > 0.0; }

 private:
  using OfMeans = std::function<Columns(const Columns&)>;

  [[nodiscard]] Columns reversal(const Columns& x) const {
    return Columns(x[up_]) - Columns(x[down_]);
  }
  [[nodiscard]] Columns sum(const Columns& x) const { return Columns(x[up_]) + Columns(x[down_]); }
  [[nodiscard]] Columns u_reversal() const { return root_of_squares(u_[up_], u_[down_]); }
  [[nodiscard]] FigureInterval span(const OfMeans& of_means, const Columns& u, bool spreads) const;
  [[nodiscard]] FigureInterval norm(const OfMeans& of_means, const Columns& u) const;
  [[nodiscard]] Columns with_common(const Columns& u, const OfMeans& common) const;

  RunSpread spread_;
  std::slice up_, down_;
  Columns mean_, u_, sigma_, u_sigma_;
  bool stated_ = false;
  std::vector<RunDraw> draw_;
};

// √(u² + s²), s: root mean square of common errors over the draws.
Columns PositioningFigures::with_common(const Columns& u, const OfMeans& common) const {
  if (!stated_) return u;
  Columns squares(0.0, u.size());
  for (const RunDraw& d : draw_) {
    const Columns s = common(d.common);
    squares += s * s;
  }
  return std::sqrt(u * u + squares / static_cast<double>(draw_.size()));
}

FigureInterval PositioningFigures::span(const OfMeans& of_means, const Columns& u,
                                        bool spreads) const {
  // Where the spread counts, both ends are as far out as it.
  const auto values = [&](const Columns& means, const Columns& out) {
    const Columns x = of_means(means);
    if (!spreads) return SpanValues{list(x), list(x)};
    return SpanValues{list(x + 2.0 * out), list(x - 2.0 * out)};
  };
  const Columns none(0.0, mean_.size());
  NoisyDraws<SpanValues> draws;
  draws.data = values(mean_, sigma_);
  draws.u = list(u);
  draws.u_selection = list(with_common(u, [&](const Columns& s) -> Columns {
    const Columns x = of_means(s);
    return x - x.sum() / static_cast<double>(x.size());
  }));
  for (const RunDraw& d : draw_) {
    draws.low.push_back(values(d.mean + d.common, sigma_ * d.spread_low));
    draws.high.push_back(values(d.mean, sigma_ * d.spread_high));
    if (stated_) draws.common.push_back(values(d.common, none));
  }
  return interval_of(draws);
}

FigureInterval PositioningFigures::norm(const OfMeans& of_means, const Columns& u) const {
  const auto values = [&](const Columns& means) { return NormValues{1, list(of_means(means))}; };
  NoisyDraws<NormValues> draws;
  draws.data = values(mean_);
  draws.u = list(u);
  draws.u_selection = list(with_common(u, of_means));
  for (const RunDraw& d : draw_) {
    draws.low.push_back(values(d.mean + d.common));
    draws.high.push_back(values(d.mean));
    if (stated_) draws.common.push_back(values(d.common));
  }
  return interval_of(draws);
}

// The first target has no deviation from itself and is left out; its noise is in all others.
FigureInterval PositioningFigures::largest() const {
  const std::size_t others = up_.size() - 1;
  const std::slice behind(1, others, 1);
  const auto from_first = [&](const Columns& x) -> Columns {
    const Columns M = 0.5 * sum(x);
    return Columns(M[behind]) - M[0];
  };
  const Columns u_mean = 0.5 * u_reversal();
  return norm(from_first, root_of_squares(u_mean[behind], Columns(u_mean[0], others)));
}

FigureInterval PositioningFigures::R() const {
  const auto values = [this](const Columns& means, const Columns& out) {
    const Columns B = reversal(means);
    const Columns both = 2.0 * sum(out);
    return PeakValues{list(joined(joined(both + B, both - B), 4.0 * out))};
  };
  const Columns none(0.0, mean_.size());
  const Columns u_both = root_of_squares(u_reversal(), 2.0 * sum(u_sigma_));
  const Columns u = joined(joined(u_both, u_both), 4.0 * u_sigma_);
  NoisyDraws<PeakValues> draws;
  draws.data = values(mean_, sigma_);
  draws.u = list(u);
  draws.u_selection = list(with_common(u, [&](const Columns& s) {
    const Columns B = reversal(s);
    return joined(joined(B, B), none);
  }));
  for (const RunDraw& d : draw_) {
    draws.low.push_back(values(d.mean + d.common, sigma_ * d.spread_low));
    draws.high.push_back(values(d.mean, sigma_ * d.spread_high));
    if (stated_) draws.common.push_back(values(d.common, none));
  }
  return interval_of(draws);
}

}  // namespace

PositioningIntervals positioning_intervals(const RunReadings& readings, const StatedErrors& stated,
                                           std::uint64_t seed, std::size_t draws) {
  const PositioningFigures figures(readings, stated, seed, draws);
  return {figures.E(), figures.M(),       figures.B(),          figures.A(),
          figures.R(), figures.largest(), figures.runs_differ()};
}

RunIntervals run_intervals(const std::vector<double>& positions,
                           const std::vector<std::vector<double>>& up,
                           const std::vector<std::vector<double>>& down, const StatedErrors& stated,
                           std::uint64_t seed, std::size_t draws) {
  RunIntervals out;
  out.refusal = check_runs(positions, up, down);
  if (!out.refusal.ok()) return out;
  RunReadings readings{positions, {}};
  for (std::size_t r = 0; r < up.size(); ++r) {
    std::vector<double> columns = up[r];
    columns.insert(columns.end(), down[r].begin(), down[r].end());
    readings.run.emplace_back(columns.data(), columns.size());
  }
  out.of = positioning_intervals(readings, stated, seed, draws);
  return out;
}

}  // namespace volcomp::host
