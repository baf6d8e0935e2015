// How long a process that has one loop for everything is away from the cycle: the longest single
// piece of each kind of work of the node, with the largest tables it takes. Processor time, so that
// other work on the computer does not count; storing in wall time, as it waits for the disk.
//
//   volcomp_turns [FILE]   a file on the disk that is to keep the parameters

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "comp/core/bytes.hpp"
#include "comp/tables/image.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "hal/linux/file_blocks.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp::bench {
namespace {

constexpr std::uint8_t kId = 32;
constexpr std::size_t kAxes = 5;
constexpr std::uint32_t kPeriod_us = 2000;

void require(bool good, const char* what) {
  if (good) return;
  static_cast<void>(std::fprintf(stderr, "volcomp_turns: %s\n", what));
  std::exit(2);
}

double clock_us(clockid_t clock) {
  timespec now{};
  static_cast<void>(::clock_gettime(clock, &now));
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// Pieces of one kind of work, us.
class Pieces {
 public:
  explicit Pieces(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) : clock_(clock) {}
  template <class Work>
  void time(Work&& work) {
    const double begin = clock_us(clock_);
    work();
    us_.push_back(clock_us(clock_) - begin);
  }
  void print(const char* what) {
    std::sort(us_.begin(), us_.end());
    std::printf("%-56s %8zu %10.1f %10.1f\n", what, us_.size(), us_[us_.size() / 2], us_.back());
  }

 private:
  clockid_t clock_;
  std::vector<double> us_;
};

class Bench {
 public:
  explicit Bench(node::Storage* storage) : node_(std::make_unique<node::Node>(kId, storage)) {
    client_.set_block_threshold(64);
    node_->power_on(now_us_);
    drain();
  }

  // Each frame of the transfer is one of the pieces.
  void write(std::uint16_t index, std::uint8_t sub, const std::vector<std::uint8_t>& value,
             Pieces& pieces) {
    client_.download({index, sub}, {value.data(), value.size()}, now_us_);
    finish(pieces);
  }
  void read(std::uint16_t index, std::uint8_t sub, Pieces& pieces) {
    std::vector<std::uint8_t> value(node::kImageCapacity);
    client_.upload({index, sub}, {value.data(), value.size()}, now_us_);
    finish(pieces);
  }
  void set(std::uint16_t index, std::uint8_t sub, std::size_t bytes, std::uint64_t value,
           Pieces& pieces) {
    std::vector<std::uint8_t> data(bytes);
    store_le(data.data(), bytes, value);
    write(index, sub, data, pieces);
  }
  void set(std::uint16_t index, std::uint8_t sub, std::size_t bytes, std::uint64_t value) {
    Pieces none;
    set(index, sub, bytes, value, none);
  }
  void nmt(canopen::NmtCommand command) {
    hal::CanFrame f = frame(canopen::kNmt, 2);
    f.data[0] = static_cast<std::uint8_t>(command);
    f.data[1] = kId;
    take(f);
  }

  // The frame that completes a cycle, with the tick and the offsets that leave.
  void cycle(Pieces& last, Pieces& idle) {
    hal::CanFrame sync = frame(canopen::kSync, 1);
    sync.data[0] = counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
    take(sync);
    for (unsigned a = 1; a <= kAxes; ++a) {
      hal::CanFrame status = frame(0x180 + a, 8);
      store_le(status.data.data(), 4, static_cast<std::uint32_t>(kPosition));
      store_le(&status.data[4], 2, 0x0127);
      take(status);
      hal::CanFrame held = frame(0x480 + a, 4);
      std::copy_n(held_[a].begin(), 4, held.data.begin());
      take(held);
      hal::CanFrame target = frame(0x200 + a, 6);
      target.data[0] = 0x0F;
      store_le(&target.data[2], 4, static_cast<std::uint32_t>(kPosition));
      if (a < kAxes)
        take(target);
      else
        last.time([&] { take(target); });
    }
    for (std::uint32_t passed = 0; passed < kPeriod_us; passed += 500) {
      now_us_ += 500;
      idle.time([&] { poll(); });
    }
  }
  [[nodiscard]] std::uint8_t state() const { return node_->objects().state; }

 private:
  static constexpr std::int32_t kPosition = -100'000'000;

  static hal::CanFrame frame(unsigned id, std::uint8_t size) {
    hal::CanFrame f;
    f.id = static_cast<std::uint16_t>(id);
    f.size = size;
    return f;
  }
  void finish(Pieces& pieces) {
    canopen::SdoData request{};
    while (client_.request(request)) {
      const hal::CanFrame f{static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request};
      pieces.time([&] { take(f); });
    }
    require(client_.state() != canopen::SdoClient::State::busy &&
                client_.abort_code() == canopen::AbortCode::none,
            "an object was refused");
  }
  void take(const hal::CanFrame& f) {
    node_->device().receive(f, now_us_);
    drain();
  }
  void poll() {
    node_->device().poll(now_us_);
    drain();
  }
  void drain() {
    hal::CanFrame f;
    while (node_->device().offer(f, now_us_)) {
      node_->device().taken(now_us_);
      if (f.id == canopen::kSdoResponse + kId) client_.response(f.data, now_us_);
      if (f.id > 0x300 && f.id <= 0x300 + kAxes) held_[f.id - 0x300U] = f.data;
    }
  }

  std::unique_ptr<node::Node> node_;
  canopen::SdoClient client_;
  std::array<std::array<std::uint8_t, 8>, kAxes + 1> held_{};
  std::uint64_t now_us_ = 0;
  std::uint8_t counter_ = 0;
};

std::vector<std::uint8_t> largest_image() {
  const auto tables = make_tables(kFiveAxis, 128);
  std::vector<std::uint8_t> bytes(image_size(*tables));
  std::size_t written = 0;
  require(encode_image(*tables, bytes, written).ok(), "the image cannot be written");
  return bytes;
}

void run(node::Storage* storage) {
  Bench bench(storage);
  bench.set(0x1006, 0, 4, kPeriod_us);
  for (std::uint8_t a = 1; a <= kAxes; ++a)
    bench.set(0x2010, a, 1, a);
  Pieces download;
  Pieces upload;
  Pieces activate;
  Pieces last;
  Pieces idle;
  Pieces save(CLOCK_MONOTONIC);
  const std::vector<std::uint8_t> image = largest_image();
  for (int i = 0; i < 20; ++i) {
    bench.write(0x2110, 1, image, download);
    bench.set(0x2111, 0, 1, static_cast<std::uint8_t>(node::TableCommand::activate), activate);
    bench.nmt(canopen::NmtCommand::start);
    for (int cycle = 0; cycle < 2000; ++cycle)
      bench.cycle(last, idle);
    require(bench.state() == static_cast<std::uint8_t>(node::NodeState::compensating),
            "it does not compensate");
    bench.nmt(canopen::NmtCommand::enter_pre_operational);
    bench.read(0x2110, 1, upload);
    if (storage != nullptr) bench.set(0x1010, 1, 4, 0x65766173, save);
  }
  std::printf("%zu bytes of tables\n%-56s %8s %10s %10s\n", image.size(), "work", "pieces",
              "median us", "longest us");
  last.print("last frame of a cycle, with tick and offsets");
  idle.print("a look at the time, with a step of the memory check");
  download.print("a frame of a table download (2110h)");
  upload.print("a frame of a table upload");
  activate.print("check, fold and activate tables (2111h)");
  if (storage != nullptr) save.print("store everything (1010h), by the wall");
}

int start(int argc, char** argv) {
  if (argc < 2) {
    run(nullptr);
    return 0;
  }
  hal::FileBlocks blocks;
  require(blocks.open(argv[1]).ok(), "the file cannot be used");
  node::RecordStorage<hal::FileBlocks> storage(blocks);
  run(&storage);
  return 0;
}

}  // namespace
}  // namespace volcomp::bench

int main(int argc, char** argv) { return volcomp::bench::start(argc, argv); }
