// Any frames at any times into a node with active tables: what it offers is bounded, its offsets
// keep slew limit and limit, and after a reset it is as new.
//
// The input is cut into 10 bytes each: what kind of frame, how much time passes before it and how
// long it is, and its data.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "comp/core/bytes.hpp"
#include "comp/tables/image.hpp"
#include "firmware/node/node.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint8_t kId = 32;
constexpr std::size_t kRecord = 10;

void require(bool condition) {
  if (!condition) std::abort();
}

std::vector<std::uint8_t> make_image() {
  const auto tables = std::make_unique<MachineTables>();
  tables->machine = kXyfzMachine;
  for (std::size_t a = 0; a < 3; ++a) {
    AxisTable& table = tables->axis[a];
    table.q0 = -500'000'000;
    table.pitch = 100'000'000;
    table.knots = 6;
    for (std::size_t k = 0; k < table.knots; ++k)
      table.value[0][k] = table.value[1][k] = {1e3F * static_cast<float>(k), -2e4F, 3e3F, 1e-5F};
    tables->expansion[a] = {11.7e-6F, 0.0F, static_cast<std::uint8_t>(a)};
  }
  std::vector<std::uint8_t> image(image_size(*tables));
  std::size_t written = 0;
  require(encode_image(*tables, {image.data(), image.size()}, written).ok());
  return image;
}

// Three axes on drives 1, 2, 3, SYNC with counter, and tables: what a configured node has stored.
class Stored final : public Storage {
 public:
  StoreResult save(Span<const std::uint8_t> /*parameters*/,
                   Span<const std::uint8_t> /*image*/) override {
    return StoreResult::done;
  }
  StoreResult erase() override { return StoreResult::done; }
  StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override {
    static const std::vector<std::uint8_t> kImage = make_image();
    static const std::vector<std::uint8_t> kParameters{
        0x06, 0x10, 0, 4, 0xD0, 0x07, 0,    0,  // 1006h = 2000 us
        0x19, 0x10, 0, 1, 240,                  // 1019h
        0x10, 0x20, 1, 1, 1,                    // 2010h
        0x10, 0x20, 2, 1, 2,    0x10, 0x20, 3, 1, 3};
    fill(kParameters, parameters);
    if (image.data() != nullptr) fill(kImage, image);
    return StoreResult::loaded;
  }

 private:
  static void fill(const std::vector<std::uint8_t>& from, Span<std::uint8_t>& to) {
    require(from.size() <= to.size());
    std::copy(from.begin(), from.end(), to.begin());
    to = {to.data(), from.size()};
  }
};

// Mostly what the node listens to.
std::uint16_t identifier(std::uint8_t kind, std::uint8_t other) {
  constexpr std::array<std::uint16_t, 16> kHeard{0x000, 0x080, 0x080, 0x181, 0x182, 0x183,
                                                 0x201, 0x202, 0x203, 0x481, 0x482, 0x483,
                                                 0x620, 0x701, 0x77F, 0x7FF};
  const std::uint16_t id = kHeard[kind % kHeard.size()];
  return id != 0x7FF ? id : static_cast<std::uint16_t>((kind << 4U | other) & hal::kMaxCanId);
}

class Watched {
 public:
  Watched() {
    node_->power_on(0);
    drain();
    give({canopen::kNmt, 2, {1, 0}});
  }

  void pass(std::uint64_t us) {
    now_us_ += us;
    node_->device().poll(now_us_);
    check(2);  // a SYNC of its own cuts a cycle short, and the next may be due at once
    drain();
  }

  void give(const hal::CanFrame& frame) {
    node_->device().receive(frame, now_us_);
    check(1);
    drain();
  }

  // First and last frame that follow.
  hal::CanFrame first{};
  hal::CanFrame last{};

 private:
  void drain() {
    constexpr int kMost = 256;
    hal::CanFrame frame;
    int count = 0;
    while (node_->device().offer(frame, now_us_)) {
      require(frame.id <= hal::kMaxCanId && frame.size <= 8);
      node_->device().taken(now_us_);
      if (count == 0) first = frame;
      last = frame;
      require(++count <= kMost);
    }
  }

  // An offset moves by one slew limit, or starts within it of what its drive holds. It is never
  // larger than the limit or what some drive has held.
  void check(std::int64_t cycles) {
    const NodeObjects& o = node_->objects();
    for (std::size_t a = 0; a < kNodeAxes; ++a) {
      const WireScale scale{o.scale_numerator[a], o.scale_denominator[a], o.rotary[a] != 0};
      const std::int64_t slew = step_to_wire(o.slew[a], scale);
      const std::int64_t held = o.held_offset[a];
      const std::int64_t start = offset_to_wire(o.start_offset[a], scale);
      const std::int64_t limit = offset_to_wire(o.limit[a], scale);
      reach_[a] = std::max({reach_[a], std::abs(held), std::abs(start), limit});
      const std::int64_t now = o.offset[a];
      if (now == offset_[a]) continue;
      const bool near_last = std::abs(now - offset_[a]) <= cycles * slew;
      const bool near_held = std::abs(now - held) <= cycles * slew;
      const bool near_start = std::abs(now - start) <= cycles * slew;
      require(near_last || near_held || near_start);
      require(std::abs(now) <= reach_[a] + 1);
      offset_[a] = now;
    }
    // Nothing is sent now. What was sent last stays to be read; a reset forgets it.
    if (node_->device().state() != canopen::NmtState::operational)
      std::copy(o.offset.begin(), o.offset.end(), offset_.begin());
  }

  Stored stored_;
  std::unique_ptr<Node> node_ = std::make_unique<Node>(kId, &stored_);
  std::uint64_t now_us_ = 0;
  PerAxis<std::int64_t> offset_{};
  PerAxis<std::int64_t> reach_{};
};

void run(const std::uint8_t* data, std::size_t size) {
  Watched node;
  for (std::size_t at = 0; at + kRecord <= size; at += kRecord) {
    const std::uint8_t kind = data[at];
    const std::uint8_t pace = data[at + 1];
    node.pass(250U * static_cast<std::uint64_t>(pace >> 4U));
    hal::CanFrame frame;
    frame.id = identifier(kind, pace);
    frame.size = std::min<std::uint8_t>(pace & 0x0FU, 8);
    std::copy_n(data + at + 2, frame.size, frame.data.begin());
    node.give(frame);
  }
  node.give({canopen::kNmt, 2, {129, kId}});
  require(node.first == hal::CanFrame{canopen::kHeartbeat + kId, 1, {0}});
  node.give({canopen::kSdoRequest + kId, 8, {0x40, 0x18, 0x10, 0x02}});
  require(node.last.id == canopen::kSdoResponse + kId && node.last.data[0] == 0x43);
}

}  // namespace
}  // namespace volcomp::node

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  volcomp::node::run(data, size);
  return 0;
}
