// Measures what watching and correcting the strokes of a helical grinder costs on the board.
//
//   toolchain/run-firmware m7 strokes
//
// Lines of a word and fields name=value, instructions:
//   stroke count=… away_least=… away_most=… face_least=… face_most=…   the share of a tick in it
//   learning passes=… collect=… learn=…               background, at most; learn with three tables
// away: outside the face; face: in it. Tables are in force from the second round on. Exit code 1
// when the counter cannot be trusted or something was refused.

#include <algorithm>
#include <memory>

#include "comp/core/units.hpp"
#include "firmware/node/strokes/stroke_service.hpp"
#include "tests/target/text.hpp"
#include "tests/target/ticks/cost.hpp"

namespace volcomp::target {
namespace {

using node::LearnCommand;
using node::StrokeCycle;

constexpr std::uint32_t kPeriod_us = 2000;
constexpr std::int32_t kStep_nm = 26'800;  // 13.4 mm/s
constexpr std::int32_t kFace_nm = 22'500'000;
constexpr std::int32_t kEnd_nm = 26'800'000;
constexpr std::uint16_t kSlots = 79;
constexpr int kRounds = 2;
constexpr int kSlotsGround = 6;

struct Span32 {
  std::uint32_t least = UINT32_MAX;
  std::uint32_t most = 0;

  void add(std::uint32_t value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

class Grinder {
 public:
  Grinder() {
    objects_->axis = {1, 2, 3};
    objects_->slots = kSlots;
    objects_->nodes = 181;
    objects_->first_node_nm = -kFace_nm;
    objects_->gear = {1.0 / 305.25, 74.25, 0.325};
    objects_->wavelength_mm = {10.0, 5.0, 2.5, 1.25};
    objects_->frequency_hz = {25.0, 50.0, 0.0, 0.0};
    objects_->least_samples = {1, 1};
    require(service_->switch_on(kPeriod_us));
    require(service_->restart({node::WireScale{}, node::WireScale{}, {512, 1, true}}, kPeriod_us));
  }

  void measure() {
    for (int round = 0; round < kRounds; ++round) {
      for (std::uint16_t slot = 0; slot < kSlotsGround; ++slot) {
        stroke(slot, true);
        stroke(slot, false);
      }
      learn_ = std::max(learn_, instructions_of([&] { require(learn()); }));
    }
    put("stroke");
    put_field("count", count_);
    put_field("away_least", away_.least);
    put_field("away_most", away_.most);
    put_field("face_least", face_.least);
    put_field("face_most", face_.most);
    put("\nlearning");
    put_field("passes", passes_);
    put_field("collect", collect_);
    put_field("learn", learn_);
    put('\n');
  }

 private:
  Status learn() { return service_->learn(LearnCommand::learn); }

  void stroke(std::uint16_t slot, bool up) {
    const std::int32_t sign = up ? 1 : -1;
    tick(-sign * kEnd_nm, slot, up, true);
    for (std::int32_t way = -kEnd_nm; way <= kEnd_nm; way += kStep_nm)
      tick(sign * way, slot, up, false);
    const std::uint32_t collect = instructions_of([&] { service_->work(); });
    collect_ = std::max(collect_, collect);
    ++passes_;
  }

  // Z lags by 0.16 mm, C by what belongs to it and 20 µrad more.
  void tick(std::int32_t z, std::uint16_t slot, bool up, bool end) {
    const bool in_face = z >= -kFace_nm && z <= kFace_nm;
    StrokeCycle cycle;
    cycle.has_state = cycle.corrected = true;
    const std::int32_t lag = up ? -160'000 : 160'000;
    const std::int32_t c = turned(z);
    cycle.axis[0] = {44'000'000, 44'000'300, true, true, true};
    cycle.axis[1] = {z, last_z_ + lag, true, true, true};
    cycle.axis[2] = {c, last_c_ + turned(lag) + 6'836, true, true, true};
    objects_->slot = slot;
    objects_->flags =
        static_cast<std::uint16_t>((in_face ? node::kInFace : 0U) | (end ? node::kStrokeEnd : 0U) |
                                   (up ? node::kStrokeForward : node::kStrokeBackward));
    objects_->feed_nm_per_s = 13'400'000;
    const std::uint32_t cost = instructions_of([&] { service_->tick(cycle); });
    // What is watched are the targets of the tick before.
    (was_in_face_ ? face_ : away_).add(cost);
    was_in_face_ = in_face;
    ++count_;
    last_z_ = z;
    last_c_ = c;
  }

  // C of a helix, 2^-31 turn.
  static std::int32_t turned(std::int32_t z_nm) {
    return static_cast<std::int32_t>(std::int64_t{-z_nm} * 1120 / 1000);
  }

  std::unique_ptr<node::StrokeObjects> objects_ = std::make_unique<node::StrokeObjects>();
  std::unique_ptr<node::StrokeService> service_ =
      std::make_unique<node::StrokeService>(*objects_, nullptr);
  std::int32_t last_z_ = 0;
  std::int32_t last_c_ = 0;
  bool was_in_face_ = false;
  Span32 away_{};
  Span32 face_{};
  std::uint32_t count_ = 0;
  std::uint32_t passes_ = 0;
  std::uint32_t collect_ = 0;
  std::uint32_t learn_ = 0;
};

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  counter.start();
  Grinder().measure();
  if (!counter.exact()) stop("QEMU was not started with -icount shift=6,sleep=off.");
  return 0;
}
