#include "host_sim/host/measure/whole_way/whole_way.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/whole_way/task_outputs.hpp"
#include "host_sim/host/measure/whole_way/true_figures.hpp"
#include "host_sim/host/measure/whole_way/uncertain_campaign.hpp"
#include "host_sim/host/report/shared_progress.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kBlock = 25;  // campaigns that share their memory, one after the other

class WholeWay {
 public:
  WholeWay(const MachineFile& machine, const std::vector<RunsFile>& runs,
           const CampaignStatement& stated, const Task& task, const WholeWaySettings& settings)
      : settings_(settings),
        campaign_(machine, runs, stated),
        outputs_(machine, task, settings.travel) {
    settings_.build.bound = false;
    const MeasuredCampaign& found = campaign_.nominal();
    nominal_errors_ =
        outputs_.errors(build_tables(found.machine, found.runs, settings_.build)->model);
    settings_.build.drawn = true;
    nominal_ = numbers_of(nominal_errors_);
  }

  [[nodiscard]] const UncertainCampaign& campaign() const { return campaign_; }
  [[nodiscard]] const TaskOutputs& task_outputs() const { return outputs_; }
  [[nodiscard]] const Outputs& nominal() const { return nominal_; }

  // By draw.
  [[nodiscard]] std::vector<Outputs> draws(const Progress& progress) const {
    return each(settings_.draws, "draws", progress, 0.2, 1.0, [&](std::size_t d, auto& measured) {
      return at(campaign_.draw(settings_.seed, static_cast<std::uint32_t>(d)), measured);
    });
  }

  // What one standard deviation of each input does to all outputs: central differences.
  [[nodiscard]] std::vector<Outputs> effects(const Progress& progress) const {
    const std::vector<UncertainInput>& inputs = campaign_.inputs();
    return each(inputs.size(), "first order", progress, 0.0, 0.2,
                [&](std::size_t i, auto& measured) {
                  Outputs effect(nominal_.size(), 0.0);
                  if (!(inputs[i].deviation > 0.0)) return effect;
                  std::vector<double> values(inputs.size(), 0.0);
                  values[i] = inputs[i].step;
                  const Outputs above = at(values, measured);
                  values[i] = -inputs[i].step;
                  const Outputs below = at(values, measured);
                  const double half = 0.5 * inputs[i].deviation / inputs[i].step;
                  for (std::size_t k = 0; k < effect.size(); ++k)
                    effect[k] = half * (above[k] - below[k]);
                  return effect;
                });
  }

 private:
  [[nodiscard]] Outputs numbers_of(const TaskErrors& errors) const {
    Outputs out;
    for (const Vec3& e : errors)
      out.insert(out.end(), e.begin(), e.end());
    for (const FigureOfTask& figure : outputs_.figures())
      out.push_back(outputs_.figure(figure, errors, nominal_errors_));
    return out;
  }

  [[nodiscard]] Outputs at(const std::vector<double>& inputs, MeasuredCampaign& measured) const {
    campaign_.set(inputs, measured);
    return numbers_of(
        outputs_.errors(build_tables(measured.machine, measured.runs, settings_.build)->model));
  }

  // `one(i, measured)` for all i, in blocks over the threads; `from` to `to` of the progress.
  template <class One>
  std::vector<Outputs> each(std::size_t count, const char* what, const Progress& progress,
                            double from, double to, const One& one) const {
    std::vector<Outputs> all(count);
    const std::size_t blocks = (count + kBlock - 1) / kBlock;
    SharedProgress shared(progress, blocks, from, to);
    in_parallel(blocks, settings_.threads, [&](std::size_t block) {
      MeasuredCampaign measured = campaign_.nominal();
      for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
        try {
          all[i] = one(i, measured);
        } catch (const UserError& e) {
          throw UserError(
              fmt::format("{} {}: refused as readings would be, by build-tables: {}; runs or "
                          "statements are so uncertain that some of what may have been is no table",
                          what, i, e.what()));
        }
      }
      shared.show(block, 1.0, what);
    });
    return all;
  }

  WholeWaySettings settings_;
  UncertainCampaign campaign_;
  TaskOutputs outputs_;
  TaskErrors nominal_errors_;
  Outputs nominal_;
};

// The order statistic ⌈K p⌉ of sorted values.
double quantile(const std::vector<double>& sorted, double p) {
  constexpr double kRounding = 1e-9;  // K p of a whole number stays that
  const double rank = std::ceil(static_cast<double>(sorted.size()) * p - kRounding);
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

DrawnNumber drawn_number(const std::vector<Outputs>& draws, std::size_t k) {
  const auto count = static_cast<double>(draws.size());
  std::vector<double> values;
  values.reserve(draws.size());
  for (const Outputs& draw : draws)
    values.push_back(draw[k]);
  DrawnNumber n;
  for (const double v : values)
    n.mean += v / count;
  double squares = 0.0;
  for (const double v : values)
    squares += (v - n.mean) * (v - n.mean);
  n.deviation = std::sqrt(squares / (count - 1.0));
  std::sort(values.begin(), values.end());
  n.low = quantile(values, 0.025);
  n.high = quantile(values, 0.975);
  return n;
}

double first_order_of(const std::vector<Outputs>& effects, std::size_t k) {
  double squares = 0.0;
  for (const Outputs& effect : effects)
    squares += effect[k] * effect[k];
  return std::sqrt(squares);
}

double squared_deviation(const PlaceUncertainty& place) {
  double sum = 0.0;
  for (const DrawnNumber& e : place.error)
    sum += e.deviation * e.deviation;
  return sum;
}

std::vector<GroupShare> shares_at(std::size_t place, const std::vector<UncertainInput>& inputs,
                                  const std::vector<Outputs>& effects) {
  std::vector<GroupShare> shares;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    auto found = std::find_if(shares.begin(), shares.end(), [&](const GroupShare& share) {
      return share.group == inputs[i].group;
    });
    if (found == shares.end()) found = shares.insert(found, {inputs[i].group, Vec3::Zero()});
    for (std::size_t c = 0; c < 3; ++c) {
      const double effect = effects[i][3 * place + c];
      found->u(static_cast<Eigen::Index>(c)) += effect * effect;
    }
  }
  for (GroupShare& share : shares)
    share.u = share.u.cwiseSqrt();
  std::stable_sort(shares.begin(), shares.end(), [](const GroupShare& a, const GroupShare& b) {
    return a.u.squaredNorm() > b.u.squaredNorm();
  });
  return shares;
}

// Beyond its targets a table holds its end.
std::vector<std::string> places_beyond(const MachineFile& machine,
                                       const std::vector<RunsFile>& runs, const Task& task) {
  std::vector<std::string> remarks;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const auto file = std::find_if(runs.begin(), runs.end(), [&](const RunsFile& r) {
      return r.letter == machine.axes[a].letter;
    });
    if (file == runs.end() || machine.axes[a].full_turn()) continue;
    const std::vector<double>& targets = file->positions;
    const double first = *std::min_element(targets.begin(), targets.end());
    const double last = *std::max_element(targets.begin(), targets.end());
    const auto beyond = std::count_if(task.places.begin(), task.places.end(),
                                      [&](const Pose& q) { return q[a] < first || q[a] > last; });
    if (beyond == 0) continue;
    remarks.push_back(fmt::format(
        "{} of {} places are beyond the targets of {}: the error of its last target is used there",
        beyond, task.places.size(), machine.axes[a].letter));
  }
  return remarks;
}

void check_size(const Task& task, const WholeWaySettings& settings) {
  if (settings.draws < kFewestDraws || settings.draws > kMostDraws)
    throw UserError(
        fmt::format("{} draws: {} to {} are possible", settings.draws, kFewestDraws, kMostDraws));
  if (task.places.size() * settings.draws > kMostDrawnPlaces)
    throw UserError(fmt::format("{}: {} places with {} draws are too many: at most {} together",
                                task.name, task.places.size(), settings.draws, kMostDrawnPlaces));
}

void check_uncertain(const UncertainCampaign& campaign) {
  const bool any = std::any_of(campaign.inputs().begin(), campaign.inputs().end(),
                               [](const UncertainInput& input) { return input.deviation > 0.0; });
  if (!any)
    throw UserError(
        "nothing is uncertain: the runs do not scatter, or there are too few, and nothing is "
        "stated");
}

}  // namespace

std::optional<double> DrawnNumber::ratio() const {
  constexpr double kRounding_mm = 1e-9;
  if (!first_order || !(*first_order > kRounding_mm)) return std::nullopt;
  return deviation / *first_order;
}

double TaskUncertainty::ratio_band(std::size_t draws) {
  return 3.0 / std::sqrt(2.0 * static_cast<double>(draws));
}

TaskUncertainty uncertainty_of_task(const MachineFile& machine, const std::vector<RunsFile>& runs,
                                    const CampaignStatement& stated, const Task& task,
                                    const WholeWaySettings& settings, const Progress& progress) {
  check_size(task, settings);
  const WholeWay way(machine, runs, stated, task, settings);
  check_uncertain(way.campaign());
  const std::vector<Outputs> effects = way.effects(progress);
  const std::vector<Outputs> draws = way.draws(progress);
  const auto number = [&](std::size_t k) {
    DrawnNumber n = drawn_number(draws, k);
    n.nominal = way.nominal()[k];
    n.first_order = first_order_of(effects, k);
    return n;
  };
  TaskUncertainty u;
  for (std::size_t p = 0; p < task.places.size(); ++p)
    u.places.push_back({task.places[p], {number(3 * p), number(3 * p + 1), number(3 * p + 2)}});
  const TrueFigures truth(way.nominal(), draws, u.places);
  const std::vector<FigureOfTask>& figures = way.task_outputs().figures();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    TaskFigure f{figures[i].key, figures[i].name, number(3 * task.places.size() + i), {}};
    if (figures[i].kind == FigureOfTask::Kind::from_nominal)
      f.drawn.first_order.reset();  // has a kink at 0
    if (figures[i].kind == FigureOfTask::Kind::largest) f.truth = truth.largest();
    if (figures[i].kind == FigureOfTask::Kind::along)
      f.truth = truth.range_along(way.task_outputs().direction());
    u.figures.push_back(std::move(f));
  }
  const auto worst = std::max_element(u.places.begin(), u.places.end(),
                                      [](const PlaceUncertainty& a, const PlaceUncertainty& b) {
                                        return squared_deviation(a) < squared_deviation(b);
                                      });
  u.worst = static_cast<std::size_t>(worst - u.places.begin());
  u.inputs = way.campaign().inputs().size();
  u.shares = shares_at(u.worst, way.campaign().inputs(), effects);
  u.drawn_as_zero = way.campaign().drawn_as_zero();
  u.remarks = places_beyond(machine, runs, task);
  progress(1.0, "done");
  return u;
}

}  // namespace volcomp::host
