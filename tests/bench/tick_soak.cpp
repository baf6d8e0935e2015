// Ticks of every compiled and loaded machine for a very long time, over tables that are right and
// tables made to hurt, with positions anywhere, settings that change and tables that are exchanged:
// no offset leaves its limit, its rate or its acceleration.
//
//   volcomp_tick_soak [--ticks 1000000] [--seed 1]        10^8 take minutes, with sanitizers an
//   hour

#include <cstdlib>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "tests/bench/soak_options.hpp"
#include "tests/oracle/hostile_machines.hpp"
#include "tests/oracle/offset_promise.hpp"

namespace volcomp::test {
namespace {

constexpr std::uint64_t kEpisodeTicks = 10'000;
constexpr std::array<std::int64_t, 10> kExtremes{
    INT64_MIN,         INT64_MIN + 1, INT64_MAX,        -1,   0, 1,
    -kMaxPosition - 1, -kMaxPosition, kMaxPosition + 1, kTurn};

// Larger numbers are as frequent as smaller ones: of every length in bits alike.
std::int64_t any_size(Random& random, std::int64_t most) {
  const auto bits = static_cast<unsigned>(random.integer(0, 62));
  return 1 + random.integer(0, (std::int64_t{1} << bits) - 1) % most;
}

std::int32_t any_size(Random& random, std::int32_t most) {
  return static_cast<std::int32_t>(any_size(random, std::int64_t{most}));
}

struct Counts {
  std::uint64_t ticks = 0;
  std::uint64_t staged = 0;
  std::uint64_t refused = 0;
  std::uint64_t configured = 0;
  std::uint64_t without_news = 0;  // axes that had nothing to report
};

// Where one axis goes: a while in one manner, then in another.
class AxisWalk {
 public:
  void begin(Random& random) {
    manner_ = random.chance(0.6) ? Manner::strolls : static_cast<Manner>(random.integer(0, 4));
    stride_ = any_size(random, std::int64_t{2'000'000});
    doubtful_ = random.chance(0.1);
  }

  AxisSample next(const TableGrid& grid, Random& random) {
    switch (manner_) {
      case Manner::strolls:
        if (position_ < grid.q0 || position_ > grid.last()) position_ = place_in(grid, random);
        position_ += random.integer(-stride_, stride_);
        break;
      case Manner::stands:
        break;
      case Manner::jumps:
        position_ = place_in(grid, random);
        break;
      case Manner::anywhere:
        position_ = random.integer(INT64_MIN, INT64_MAX);
        break;
      case Manner::extreme:
        position_ = kExtremes[static_cast<std::size_t>(random.integer(0, 9))];
        break;
    }
    if (!doubtful_) return {position_, true, true};
    return {position_, random.chance(0.7), random.chance(0.7)};
  }

 private:
  enum class Manner : std::uint8_t { strolls, stands, jumps, anywhere, extreme };

  static std::int64_t place_in(const TableGrid& grid, Random& random) {
    return random.integer(grid.q0, std::max(grid.q0, grid.last()));
  }

  Manner manner_ = Manner::strolls;
  std::int64_t stride_ = 0;
  std::int64_t position_ = 0;
  bool doubtful_ = false;
};

// `Accelerates`: settings may have an acceleration.
template <class Unit, bool Accelerates = true>
class Soak {
 public:
  Soak(const char* name, Random& random, Counts& counts)
      : name_(name), random_(random), counts_(counts), unit_(std::make_unique<Unit>()) {}

  // One machine, from its start on. False when a promise is broken, which it prints.
  bool episode(const ImageBytes& good, std::uint64_t ticks) {
    if (!begin(good)) return true;
    for (; ticks > 0; --ticks) {
      if (random_.chance(0.01)) begin_walks();
      if (random_.chance(0.003)) something_happens();
      if (!tick()) return false;
    }
    return true;
  }

 private:
  using Offsets = std::array<std::int32_t, Unit::kAxes>;

  ImageBytes image_like(const ImageBytes& good) {
    ImageBytes image = good;
    if (random_.chance(0.7)) HostileImage(image.data(), image.size()).mutate(bits_);
    return image;
  }

  bool begin(const ImageBytes& good) {
    bits_.seed(static_cast<std::uint64_t>(random_.integer(0, INT64_MAX)));
    image_ = image_like(good);
    if (!check_image({image_.data(), image_.size()}, kDefaultKnots, view_).ok()) {
      image_ = good;
      if (!check_image({image_.data(), image_.size()}, kDefaultKnots, view_).ok()) return false;
    }
    const RuntimeChain chain = make_runtime_chain(view_.chain.description());
    if (chain.axes > Unit::kAxes) return false;
    if constexpr (Unit::kAxes == LoadedCompensator::kAxes) {
      unit_->restart(std::decay_t<decltype(unit_->machine())>{chain});
    } else {
      unit_->restart({});
    }
    promise_.started({});
    accelerates_ = Accelerates && random_.chance(0.7);
    configure();
    if (random_.chance(0.2)) start_from();
    stage();
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      grid_[a] = view_.axis[a].grid();
    begin_walks();
    return true;
  }

  void configure() {
    for (AxisLimits& l : settings_.axis) {
      l.limit = any_size(random_, 4'194'303);
      l.rate = any_size(random_, 1'000'000'000);
      l.soft_rate = any_size(random_, l.rate);
      l.acceleration = 0;
      if (accelerates_)
        l.acceleration = any_size(random_, std::min(l.rate, kMostOffsetAcceleration));
      l.hysteresis = any_size(random_, 4'194'303) - 1;
      l.max_step = random_.chance(0.5) ? 0 : any_size(random_, INT64_MAX);
    }
    settings_.source = random_.chance(0.5) ? PositionSource::target : PositionSource::actual;
    settings_.ramp_ticks = static_cast<std::uint32_t>(any_size(random_, 400));
    settings_.stale_drop_ticks = static_cast<std::uint16_t>(any_size(random_, 100) - 1);
    if (!unit_->configure(settings_).ok()) std::abort();
    promise_.configured(settings_);
    ++counts_.configured;
  }

  void start_from() {
    Offsets offsets{};
    for (std::int32_t& offset : offsets) {
      offset = any_size(random_, 1 << 30);
      if (random_.chance(0.5)) offset = -offset;
    }
    if (!unit_->start_from(offsets).ok()) std::abort();
    promise_.started(offsets);
  }

  // The one jump there is: the drive takes no offset at present.
  void begin_at_zero() {
    const auto axis = static_cast<std::size_t>(random_.integer(0, Unit::kAxes - 1));
    unit_->begin_at_zero(axis);
    promise_.started_at_zero(axis);
  }

  void stage() {
    const Vec3 tool = tool_of(view_.chain.description());
    const bool ok = unit_->stage(view_, tool, 1).ok() && unit_->activate().ok();
    ++(ok ? counts_.staged : counts_.refused);
  }

  // Tables of this machine or, by a mutation, of another: those are refused.
  void exchange() {
    if (unit_->pending()) return;
    const ImageBytes image = image_like(image_);
    if (check_image({image.data(), image.size()}, kDefaultKnots, view_).ok()) stage();
  }

  void something_happens() {
    switch (random_.integer(0, 9)) {
      case 0:
      case 1:
        return exchange();
      case 2:
        return unit_->deactivate();
      case 3:
        return start_from();
      case 4:
        static_cast<void>(unit_->scrub());
        return;
      case 5:
        return begin_at_zero();
      default:
        return configure();
    }
  }

  void begin_walks() {
    const bool usual = random_.chance(0.5);
    for (AxisWalk& walk : walk_) {
      if (!usual || random_.chance(0.5)) walk.begin(random_);
    }
  }

  bool tick() {
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      in_.axis[a] = walk_[a].next(grid_[a], random_);
    unit_->tick(in_, out_);
    ++counts_.ticks;
    for (const std::uint16_t status : out_.status)
      counts_.without_news += status == kValid ? 1U : 0U;
    std::size_t axis = 0;
    const char* const broken = promise_.broken_by(*unit_, out_, axis);
    if (broken == nullptr) return true;
    if (axis == Unit::kAxes) axis = 0;
    const LimitedPromise& of = promise_.of(axis);
    fmt::print(stderr, "tick_soak: tick {}, {}, axis {}: {} by {}, status {:#x}, limit {}: {}\n",
               counts_.ticks, name_, axis, of.offset(), of.step(), out_.status[axis],
               of.limits().now().limit, broken);
    return false;
  }

  const char* name_;
  Random& random_;
  Counts& counts_;
  std::mt19937_64 bits_;
  std::unique_ptr<Unit> unit_;
  typename Unit::Settings settings_{};
  OffsetPromise<Unit> promise_{};
  ImageBytes image_;          // what the episode began with
  TablesView view_;           // of the image checked last, while it lives
  bool accelerates_ = false;  // limits have an acceleration in this episode
  std::array<TableGrid, Unit::kAxes> grid_{};
  std::array<AxisWalk, Unit::kAxes> walk_{};
  typename Unit::Input in_{};
  typename Unit::Output out_{};
};

using RateAlone = Compensator<CompiledMachine<kXyfzMachine>, kDefaultKnots, OffsetLimiter<false>>;

bool run(std::uint64_t ticks, std::uint64_t seed) {
  Random random(seed);
  Counts counts;
  const std::vector<ImageBytes> seeds = hostile_seeds(random);
  Soak<XyfzCompensator> compiled("compiled in", random, counts);
  Soak<LoadedCompensator> position("loaded", random, counts);
  Soak<OrientingCompensator> orienting("loaded, orienting", random, counts);
  Soak<RateAlone, false> rate_alone("compiled in, rate alone", random, counts);
  bool kept = true;
  for (std::uint64_t n = 0; kept && counts.ticks < ticks; ++n) {
    const std::size_t i = n % seeds.size();
    const std::uint64_t share = std::min(kEpisodeTicks, ticks - counts.ticks);
    kept = position.episode(seeds[i], share) && orienting.episode(seeds[i], share) &&
           (!is_compiled_in(i) ||
            (compiled.episode(seeds[i], share) && rate_alone.episode(seeds[i], share)));
  }
  fmt::print(
      "{} ticks, {} tables active, {} refused, {} times configured, {} axes without news; {}\n",
      counts.ticks, counts.staged, counts.refused, counts.configured, counts.without_news,
      random.trace());
  return kept;
}

}  // namespace
}  // namespace volcomp::test

int main(int argc, char** argv) {
  const auto [ticks, seed] = volcomp::test::soak_options(argc, argv);
  return volcomp::test::run(ticks, seed) ? EXIT_SUCCESS : EXIT_FAILURE;
}
