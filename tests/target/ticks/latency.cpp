// Measures on the board from the last frame of a bus cycle to the last frame to a drive: the part
// of the latency (object 2620h) that is the node's own.
//
//   toolchain/run-firmware m7 latency
//
// One line per way that corrections reach the drives (object 2034h), a word and fields name=value:
//   latency way=… count=… min=… max=…     instructions, from the interrupt to the last send()
// Three axes, XYFZ loaded, all in motion. Exit code 1 when the counter cannot be trusted or a cycle
// is not served.

#include <array>
#include <memory>
#include <vector>

#include "comp/core/bytes.hpp"
#include "comp/tables/image.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node_task.hpp"
#include "tests/bench/machines.hpp"
#include "tests/target/text.hpp"
#include "tests/target/ticks/cost.hpp"

namespace volcomp::target {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kId = 32;
constexpr std::uint8_t kDrives = 3;
constexpr std::uint32_t kPeriod_us = 2'000;

void insist(bool fine, const char* sentence) {
  if (!fine) stop(sentence);
}

hal::CanFrame frame(unsigned id, std::uint8_t size) {
  hal::CanFrame f;
  f.id = static_cast<std::uint16_t>(id);
  f.size = size;
  return f;
}

bool goes_to_a_drive(const hal::CanFrame& f) { return f.id > 0x300U && f.id <= 0x300U + kDrives; }

struct Port {
  std::vector<hal::CanFrame> in;
  std::size_t taken = 0;  // of them
  std::vector<hal::CanFrame> out;
  std::uint32_t last_to_a_drive = 0;  // ticks of the counter

  bool receive(hal::CanFrame& f) {
    if (taken == in.size()) return false;
    f = in[taken++];
    return true;
  }
  bool send(const hal::CanFrame& f) {
    out.push_back(f);
    if (goes_to_a_drive(f)) last_to_a_drive = InstructionCounter::ticks();
    return true;
  }
};

struct Clock {
  std::uint64_t us = 0;
  [[nodiscard]] std::uint64_t now_us() const { return us; }
};

// Nothing interrupts here.
struct Section {
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  void enter() {}
  void leave() {}
  // NOLINTEND(readability-convert-member-functions-to-static)
};

struct Watchdog {
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  void feed() {}
  [[nodiscard]] std::uint32_t remaining_us() const { return kPeriod_us; }
  // NOLINTEND(readability-convert-member-functions-to-static)
};

// A node, its three drives and their controller.
class Bus {
 public:
  explicit Bus(std::uint8_t way) : way_(way) {
    port_.in.reserve(kRoom);
    port_.out.reserve(kRoom);
    task_.power_on(hal::ResetCause::power_on);
    configure();
    for (int n = 0; n < kUntilAllAxesFollow; ++n) {
      enabled_ = n > 10;
      cycle();
    }
  }

  void measure(const char* name, int cycles) {
    std::uint32_t least = UINT32_MAX;
    std::uint32_t most = 0;
    for (int n = 0; n < cycles; ++n) {
      const std::uint32_t cost = cycle();
      least = cost < least ? cost : least;
      most = cost > most ? cost : most;
    }
    put("latency");
    put_field("way", name);
    put_field("count", cycles);
    put_field("min", least);
    put_field("max", most);
    put('\n');
  }

 private:
  static constexpr std::size_t kRoom = 256;
  static constexpr int kUntilAllAxesFollow = 500;
  // Inside the tables of bench::make_tables(), nm.
  static constexpr std::int64_t kFirst = -480'000'000;
  static constexpr std::int64_t kLast = -20'000'000;
  static constexpr std::int64_t kTravel = 200'000;  // per cycle: 0.1 m/s

  void configure() {
    write(0x1006, 0, kPeriod_us, 4);
    write(0x1017, 0, 10, 2);
    write(0x1029, 1, 1, 1);
    for (std::uint8_t n = 1; n <= kDrives; ++n) {
      write(0x2010, n, n, 1);
      write(0x1016, n, std::uint32_t{n} << 16U | 60'000U, 4);
      write(0x2034, n, way_, 1);
      write(0x2200, 5, way_ == 0 ? 1 : 0, 1);
    }
    const auto tables = bench::make_tables(kXyfzMachine, 61);
    Bytes image(image_size(*tables));
    std::size_t written = 0;
    insist(encode_image(*tables, {image.data(), image.size()}, written).ok(),
           "The tables do not become an image.");
    download({0x2110, 1}, image);
    write(0x2111, 0, 3, 1);
    for (std::uint8_t n = 1; way_ == 1 && n <= kDrives; ++n) {
      put_in({static_cast<std::uint16_t>(canopen::kHeartbeat + n), 1, {5}});
      write(0x2037, n, 1, 1);
    }
    put_in({canopen::kNmt, 2, {1, kId}});
    timer();
  }

  // SYNC, what the drives report, the targets; instructions from the last of them to the last
  // offset.
  std::uint32_t cycle() {
    clock_.us += kPeriod_us;
    hal::CanFrame sync = frame(canopen::kSync, 1);
    counter_ = static_cast<std::uint8_t>(counter_ % 240U + 1U);
    sync.data[0] = counter_;
    give(sync);
    for (std::uint8_t n = 1; n <= kDrives; ++n)
      report(n);
    for (std::uint8_t n = 1; n < kDrives; ++n)
      give(target(n));
    port_.out.clear();
    put_in(target(kDrives));
    const std::uint32_t start = InstructionCounter::ticks();
    const std::uint32_t before = InstructionCounter::ticks();
    task_.on_bus_interrupt();
    const std::uint32_t cost =
        counter.between(before, port_.last_to_a_drive) - counter.between(start, before);
    std::size_t frames = 0;
    for (const hal::CanFrame& f : port_.out)
      frames += goes_to_a_drive(f) ? 1U : 0U;
    insist(frames == kDrives || !enabled_, "A cycle was not served.");
    for (const hal::CanFrame& f : port_.out) {
      if (goes_to_a_drive(f))
        held_[f.id - 0x301U] = static_cast<std::uint32_t>(load_le(f.data.data(), 4));
    }
    timer();
    position_ += travel_;
    if (position_ >= kLast) travel_ = -kTravel;
    if (position_ <= kFirst) travel_ = kTravel;
    return cost;
  }

  void report(std::uint8_t n) {
    hal::CanFrame actual = frame(0x180U + n, static_cast<std::uint8_t>(way_ == 1 ? 7 : 8));
    store_le(actual.data.data(), 4, static_cast<std::uint32_t>(position_));
    store_le(&actual.data[4], 2, enabled_ ? 0x0127U : 0x0121U);
    if (way_ == 1) actual.data[6] = 8;  // 6061h
    give(actual);
    if (way_ != 0) return;
    hal::CanFrame held = frame(0x480U + n, 4);
    store_le(held.data.data(), 4, held_[n - 1U]);
    give(held);
  }

  hal::CanFrame target(std::uint8_t n) const {
    hal::CanFrame f = frame(0x200U + n, 6);
    store_le(f.data.data(), 2, enabled_ ? 0x0FU : 0x07U);
    store_le(&f.data[2], 4, static_cast<std::uint32_t>(position_));
    return f;
  }

  void put_in(const hal::CanFrame& f) {
    if (port_.taken == port_.in.size()) {
      port_.in.clear();
      port_.taken = 0;
    }
    port_.in.push_back(f);
  }
  void give(const hal::CanFrame& f) {
    put_in(f);
    task_.on_bus_interrupt();
  }
  void timer() {
    task_.on_timer_interrupt();
    while (task_.background_step()) {
    }
  }

  void write(std::uint16_t index, std::uint8_t sub, std::uint32_t value, std::size_t bytes) {
    Bytes data(bytes);
    store_le(data.data(), bytes, value);
    download({index, sub}, data);
  }

  void download(canopen::ObjectId object, const Bytes& value) {
    client_.download(object, {value.data(), value.size()}, clock_.us);
    while (client_.state() == canopen::SdoClient::State::busy) {
      canopen::SdoData request{};
      while (client_.request(request))
        put_in({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request});
      for (int n = 0; n < 2; ++n) {
        port_.out.clear();
        clock_.us += 1'000;
        timer();
        for (const hal::CanFrame& f : port_.out) {
          if (f.id == canopen::kSdoResponse + kId) client_.response(f.data, clock_.us);
        }
      }
    }
    if (client_.state() == canopen::SdoClient::State::done) return;
    put("object");
    put_field("index", object.index);
    put_field("sub", object.sub);
    put_field("abort", static_cast<std::uint32_t>(client_.abort_code()));
    put('\n');
    stop("The node refused an SDO request.");
  }

  std::uint8_t way_;
  Port port_;
  Clock clock_;
  Section section_;
  Watchdog watchdog_;
  node::NodeTask<Port, Clock, Section, Watchdog> task_{
      node::Board{port_, clock_, section_, watchdog_}, kId, nullptr};
  canopen::SdoClient client_;
  std::array<std::uint32_t, kDrives> held_{};
  std::int64_t position_ = kFirst;  // nm
  std::int64_t travel_ = kTravel;
  std::uint8_t counter_ = 0;
  bool enabled_ = false;
};

void measure(const char* name, std::uint8_t way) {
  constexpr int kCycles = 2'000;
  const auto bus = std::make_unique<Bus>(way);
  bus->measure(name, kCycles);
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  counter.start();
  measure("offset", 0);
  measure("forwarded", 1);
  if (!counter.exact()) stop("QEMU was not started with -icount shift=6,sleep=off.");
  return 0;
}
