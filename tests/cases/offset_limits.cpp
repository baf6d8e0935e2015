// Cases of limited offsets: bounds, ways to standstill, the limiter, the check before a drive.

#include <algorithm>
#include <cmath>

#include "comp/tick/limiter.hpp"
#include "comp/tick/offset_limiter.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/oracle/station_case.hpp"

namespace volcomp::cases {
namespace {

// Bits of a status in a case.
constexpr std::uint32_t kCaseClamped = 1;
constexpr std::uint32_t kCaseRate = 2;
constexpr std::uint32_t kCaseAcceleration = 4;
constexpr std::uint32_t kCaseSettling = 8;
constexpr std::uint32_t kCaseNotFinite = 16;

// A number beyond the 32 bits of a setting stays beyond its range.
std::int32_t saturated(std::int64_t number) {
  return static_cast<std::int32_t>(
      std::clamp(number, std::int64_t{INT32_MIN}, std::int64_t{INT32_MAX}));
}

OffsetLimits limits_of(const json& j) {
  OffsetLimits l;
  l.limit = saturated(j.at("limit").get<std::int64_t>());
  l.rate = saturated(j.at("rate").get<std::int64_t>());
  l.soft_rate = saturated(j.at("soft_rate").get<std::int64_t>());
  l.acceleration = saturated(j.at("acceleration").get<std::int64_t>());
  return l;
}

json bounds(const json& in) {
  const OffsetLimits l = limits_of(in.at("limits"));
  if (const char* const field = refused_field(l); field != nullptr) return {{"refused", field}};
  const OffsetBounds b(l);
  return {{"rate", b.rate},
          {"soft_rate", b.soft_rate},
          {"acceleration", b.acceleration},
          {"free", b.free},
          {"none", b.none()}};
}

json braking(const json& in) {
  const auto a = in.at("acceleration").get<std::int32_t>();
  json out = {{"stopping_way", json::array()}, {"stopping_step", json::array()}};
  for (const json& d : in.at("step"))
    out["stopping_way"].push_back(stopping_way(d.get<std::int32_t>(), a));
  for (const json& x : in.at("way"))
    out["stopping_step"].push_back(stopping_step(x.get<std::int32_t>(), a));
  return out;
}

// Runs the operations of a case. The float stage is that of the tick: what is not finite goes to 0
// at the soft rate, what is beyond the limit is clamped, the rest is rounded half to even.
class Follow {
 public:
  explicit Follow(const json& in) {
    change(limits_of(in.at("limits")));
    limiter_.start(in.at("held").get<std::int32_t>());
    for (const json& op : in.at("ops"))
      run(op);
  }
  [[nodiscard]] json out() const {
    return {{"offset", offsets_},
            {"status", statuses_},
            {"largest", limiter_.largest()},
            {"largest_lag", limiter_.largest_lag()}};
  }

 private:
  void change(const OffsetLimits& limits) {
    limit_ = limits.limit;
    limiter_.change(OffsetBounds(limits));
  }
  void run(const json& op) {
    if (op.contains("limits")) return change(limits_of(op["limits"]));
    if (op.contains("start")) return limiter_.start(op["start"].get<std::int32_t>());
    if (op.contains("hold")) {
      for (int n = op["hold"]; n > 0; --n)
        keep(limiter_.hold(), 0);
      return;
    }
    const bool soft = op.value("soft", 0) != 0;
    if (op.contains("ramp")) {
      const json& r = op["ramp"];
      for (std::int64_t i = 0; i < r.at(2).get<std::int64_t>(); ++i)
        follow(r.at(0).get<std::int64_t>() + r.at(1).get<std::int64_t>() * i, soft);
    } else if (op.contains("line")) {
      line(op["line"], soft);
    } else if (op.contains("x")) {
      for_each(op, "x", [&](const json& x) { follow_float(static_cast<float>(number(x))); });
    } else {
      for_each(op, "t", [&](const json& t) { follow(t.get<std::int64_t>(), soft); });
    }
  }
  // A list, or one value n times.
  template <class Visit>
  static void for_each(const json& op, const char* key, const Visit& visit) {
    const json& values = op[key];
    if (values.is_array()) {
      for (const json& value : values)
        visit(value);
      return;
    }
    for (int n = op.value("n", 1); n > 0; --n)
      visit(values);
  }
  void line(const json& l, bool soft) {
    const auto p = l.at(1).get<std::int64_t>();
    const auto q = l.at(2).get<std::int64_t>();
    for (std::int64_t i = 0; i < l.at(3).get<std::int64_t>(); ++i) {
      const std::int64_t whole = p * i / q;
      const std::int64_t down = p * i % q < 0 ? 1 : 0;
      follow(l.at(0).get<std::int64_t>() + whole - down, soft);
    }
  }
  void follow(std::int64_t wanted, bool soft) {
    std::int64_t t = wanted;
    if (t > limit_) t = limit_;
    if (t < -limit_) t = -limit_;
    step(static_cast<std::int32_t>(t), soft, t == wanted ? 0 : kCaseClamped);
  }
  void follow_float(float x) {
    if (!Magnitude::finite(x)) return step(0, true, kCaseNotFinite);
    const Magnitude most(static_cast<float>(limit_));
    const bool clamped = exceeds(x, most);
    step(round_half_even(clamped ? most.signed_like(x) : x), false, clamped ? kCaseClamped : 0);
  }
  void step(std::int32_t target, bool soft, std::uint32_t besides) {
    keep(soft ? limiter_.follow_softly(target) : limiter_.follow(target), besides);
  }
  void keep(std::uint32_t status, std::uint32_t besides) {
    if ((status & kRateLimited) != 0) besides |= kCaseRate;
    if ((status & kAccelerationLimited) != 0) besides |= kCaseAcceleration;
    if ((status & kSettling) != 0) besides |= kCaseSettling;
    offsets_.push_back(limiter_.offset());
    statuses_.push_back(besides);
  }

  OffsetLimiter<true> limiter_;
  std::int64_t limit_ = 0;
  std::vector<std::int32_t> offsets_;
  std::vector<std::uint32_t> statuses_;
};

json follow(const json& in) { return Follow(in).out(); }

json station(const json& in) {
  test::StationCase gate(limits_of(in.at("limits")), in.at("held").get<std::int32_t>());
  json out = {{"sent", json::array()}, {"tripped_at", nullptr}};
  for (const json& wanted : in.at("wanted")) {
    const std::size_t tick = out["sent"].size();
    out["sent"].push_back(gate.pass(wanted.get<std::int32_t>()));
    if (out["tripped_at"].is_null() && gate.tripped()) out["tripped_at"] = tick;
  }
  return out;
}

}  // namespace

void add_offset_limits(Handlers& handlers) {
  handlers["offset.bounds"] = bounds;
  handlers["offset.braking"] = braking;
  handlers["offset.follow"] = follow;
  handlers["offset.station"] = station;
}

}  // namespace volcomp::cases
