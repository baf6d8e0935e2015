#include "tests/system/forwarded/forwarded_judge.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"

namespace volcomp::sim {
namespace {

constexpr unsigned kFromNode = canopen::kRpdo1 + 0x100U;  // 300h + n
constexpr std::uint64_t kOldest = 4;  // cycles: two late on the bus, two that the node stood still
constexpr std::size_t kUnderWay = 64;
constexpr std::int64_t kRemembered = 6;  // values of the gate: 2 × 2200h:04 + 2

// The axis of an identifier of one of the PDOs of the drives 1…3.
std::optional<std::size_t> axis_of(const hal::CanFrame& frame, unsigned base) {
  const unsigned axis = frame.id - base - 1U;
  return axis < kForwardedAxes ? std::optional<std::size_t>(axis) : std::nullopt;
}

std::int32_t target_in(const hal::CanFrame& frame, std::size_t at) {
  return static_cast<std::int32_t>(load_le(&frame.data.at(at), 4));
}

bool follows(std::uint16_t statusword, std::int8_t mode) {
  return (statusword & 0x6FU) == 0x27U && mode == 8;
}

bool follows(const Cia402Drive& drive) {
  return follows(drive.objects().statusword, drive.objects().mode_display);
}

}  // namespace

void ForwardedJudge::wrong(std::size_t axis, const std::string& what) {
  if (violation_.empty()) violation_ = fmt::format("cycle {}, axis {}: {}", cycle_, axis, what);
}

void ForwardedJudge::hit(std::uint64_t cycles_more) {
  hit_.resize(std::max<std::size_t>(hit_.size(), cycle_ + cycles_more + 1), false);
  for (std::uint64_t c = cycle_; c <= cycle_ + cycles_more; ++c)
    hit_[c] = true;
}

std::uint64_t ForwardedJudge::hits_until(std::uint64_t cycle) const {
  std::uint64_t hits = 0;
  while (hits <= cycle && cycle - hits < hit_.size() && hit_[cycle - hits])
    ++hits;
  return hits;
}

void ForwardedJudge::said(const hal::CanFrame& frame) {
  if (const auto a = axis_of(frame, canopen::kRpdo1); a && frame.size == 6)
    axis_.at(*a).said[target_in(frame, 2)] = cycle_;
}

// --- node

void ForwardedJudge::node_hears(const hal::CanFrame& frame) {
  if (node_.device().state() != canopen::NmtState::operational) return;
  if (const auto a = axis_of(frame, canopen::kRpdo1); a && frame.size == 6) {
    Axis& x = axis_.at(*a);
    constexpr std::uint16_t kEnables = 0x0F;
    const bool enables = (load_le(frame.data.data(), 2) & kEnables) == kEnables;
    x.heard = target_in(frame, 2);
    if (enables && x.disabled_unseen) x.presumed = x.sent + 1;
    x.disabled_unseen = !enables;
  }
  if (const auto a = axis_of(frame, canopen::kTpdo1); a && frame.size == 7) {
    const auto word = static_cast<std::uint16_t>(load_le(&frame.data[4], 2));
    Axis& x = axis_.at(*a);
    x.disabled_unseen = false;
    if (!follows(word, static_cast<std::int8_t>(frame.data[6]))) x.told = x.sent;
  }
}

void ForwardedJudge::node_sends(const hal::CanFrame& frame) {
  const auto a = axis_of(frame, kFromNode);
  if (!a) return;
  Axis& x = axis_.at(*a);
  ++forwarded_;
  if (!x.heard) return wrong(*a, "a target that the controller has not sent");
  const SentTarget target{*x.heard, target_in(frame, 0), cycle_, ++x.sent};
  x.heard.reset();
  if (target.offset() != node_.objects().offset[*a])
    wrong(*a, fmt::format("{} is not {} plus an offset of the gate", target.sent, target.target));
  if (std::abs(target.offset()) > limit_) wrong(*a, fmt::format("offset {}", target.offset()));
  const auto said = x.said.find(target.target);
  if (said == x.said.end())
    wrong(*a, "nobody has sent this target");
  else if (cycle_ - said->second > kOldest)
    wrong(*a, fmt::format("a target of cycle {}", said->second));
  x.under_way.push_back(target);
  if (x.under_way.size() > kUnderWay) x.under_way.pop_front();
}

void ForwardedJudge::node_restarts() {
  for (Axis& x : axis_) {
    x.heard.reset();
    x.told.reset();
  }
}

// --- drive

std::optional<SentTarget> ForwardedJudge::sent_target(std::size_t axis, std::int32_t value) const {
  const auto& all = axis_.at(axis).under_way;
  const auto found = std::find_if(all.rbegin(), all.rend(),
                                  [value](const SentTarget& t) { return t.sent == value; });
  return found == all.rend() ? std::nullopt : std::optional<SentTarget>(*found);
}

void ForwardedJudge::drive_boots(std::size_t axis) {
  Axis& x = axis_.at(axis);
  x.arrived.reset();
  x.last.reset();
  x.taken.reset();
  x.served = false;
  x.booted = cycle_;
}

void ForwardedJudge::before(std::size_t axis, const Cia402Drive& drive, Cia402Device& device,
                            const hal::CanFrame& frame) {
  Axis& x = axis_.at(axis);
  x.periods = drive.periods();
  x.input.reset();
  x.served = x.served && device.state() == canopen::NmtState::operational;
  if (frame.id != kFromNode + axis + 1U) return;
  if (!drive.powered() || device.state() != canopen::NmtState::operational) return;
  const auto target = sent_target(axis, target_in(frame, 0));
  if (!target) return wrong(axis, "a frame that the node has not sent");
  if (target->cycle < x.booted) return;  // was under way
  const canopen::PdoParameters& pdo = device.pdos().receive()[1].parameters();
  const bool right = pdo.count == 1 && pdo.mapping[0] == host::cia402::target.mapped();
  if (!right) return wrong(axis, "the drive would take a target for something else");
  x.arrived = x.last = target;
  x.served = true;
}

void ForwardedJudge::input(std::size_t axis, std::int32_t target) { axis_.at(axis).input = target; }

void ForwardedJudge::after(std::size_t axis, const Cia402Drive& drive, bool takes_at_once,
                           const hal::CanFrame& frame) {
  Axis& x = axis_.at(axis);
  if (frame.id == canopen::kSync && drive.periods() != x.periods) return at_sync(axis, drive);
  if (frame.id == kFromNode + axis + 1U && takes_at_once && x.arrived && follows(drive))
    take(axis, *x.arrived);
}

// One that holds, extrapolates or keeps an old target takes none of those that came: what it goes
// on with is the last.
void ForwardedJudge::at_sync(std::size_t axis, const Cia402Drive& drive) {
  Axis& x = axis_.at(axis);
  if (!x.input) {
    if (!follows(drive)) x.taken.reset();
  } else if (x.arrived) {
    if (*x.input != x.arrived->sent) wrong(axis, fmt::format("the drive takes {}", *x.input));
    take(axis, *x.arrived);
  } else if (!x.taken && x.last && *x.input == x.last->sent) {
    take(axis, *x.last);
  }
  x.arrived.reset();
  const auto target = x.served ? std::optional<std::int32_t>(x.last->target) : std::nullopt;
  x.history.push_back({cycle_, drive.objects().controlword, target});
}

void ForwardedJudge::take(std::size_t axis, const SentTarget& target) {
  Axis& x = axis_.at(axis);
  ++taken_;
  if (target.offset() != 0) ++corrected_;
  if (!x.taken) {
    ++switched_on_;
    const bool known = x.told && target.number > *x.told;
    if (!known) ++under_way_;
    if (known && target.offset() != 0)
      wrong(axis, fmt::format("switching on adds {}", target.offset()));
  } else {
    const auto apart = std::abs(static_cast<std::int64_t>(target.number - x.taken->number));
    const std::int64_t more = std::max<std::int64_t>(apart - 1 - kRemembered, 0);
    const std::int64_t step = std::abs(target.offset() - x.taken->offset());
    const auto [first, last] = std::minmax(target.number, x.taken->number);
    const bool presumed = first <= x.presumed && x.presumed <= last && step > slew_;
    if (presumed) ++presumed_;
    if (step > (presumed ? limit_ : slew_ + more * (slew_ / 7 + 1)))
      wrong(axis, fmt::format("offset {} after {}", target.offset(), x.taken->offset()));
  }
  x.taken = target;
  x.told.reset();
}

}  // namespace volcomp::sim
