// Measures what the background of a node does on the board: SDO requests, checking an image,
// folding its tables.
//
//   toolchain/run-firmware m7 services
//
// One line per figure, a word and fields name=value:
//   sdo request=… count=… min=… max=…                    instructions, the answer fetched included
//   image machine=… bytes=… check=… fold=…               instructions
// Exit code 1 when the counter cannot be trusted or something is refused.

#include <memory>
#include <vector>

#include "comp/tables/image.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node.hpp"
#include "hal/mps2/clock.hpp"
#include "hal/mps2/instruction_counter.hpp"
#include "tests/target/stop.hpp"
#include "tests/target/text.hpp"
#include "tests/target/ticks/machines.hpp"

namespace volcomp::target {
namespace {

using hal::mps2::InstructionCounter;
using Bytes = std::vector<std::uint8_t>;

InstructionCounter counter;

void require(bool fine, const char* sentence) {
  if (!fine) stop(sentence);
}

struct Cost {
  std::uint32_t count = 0;
  std::uint32_t least = UINT32_MAX;
  std::uint32_t most = 0;

  void add(std::uint32_t instructions) {
    ++count;
    if (instructions < least) least = instructions;
    if (instructions > most) most = instructions;
  }
  void print(const char* request) const {
    put("sdo");
    put_field("request", request);
    put_field("count", count);
    put_field("min", least);
    put_field("max", most);
    put('\n');
  }
};

// A node with requests of an SDO client, every request measured.
class Services {
 public:
  Services() : node_(std::make_unique<node::Node>(kId, nullptr)) { node_->power_on(now_us_); }

  void upload(canopen::ObjectId object, Cost& cost) {
    Bytes sink(64);
    client_.upload(object, {sink.data(), sink.size()}, now_us_);
    finish(cost);
  }
  void download(canopen::ObjectId object, const Bytes& value, Cost& cost) {
    client_.download(object, {value.data(), value.size()}, now_us_);
    finish(cost);
  }

 private:
  static constexpr std::uint8_t kId = 32;

  void finish(Cost& cost) {
    canopen::SdoData request{};
    while (client_.request(request))
      ask({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request}, cost);
    require(client_.state() == canopen::SdoClient::State::done, "The node refused an SDO request.");
  }

  void ask(const hal::CanFrame& request, Cost& cost) {
    const std::uint32_t start = InstructionCounter::ticks();
    const std::uint32_t before = InstructionCounter::ticks();
    node_->device().receive(request, now_us_);
    hal::CanFrame answer;
    const bool answered = node_->device().offer(answer, now_us_);
    if (answered) node_->device().taken(now_us_);
    const std::uint32_t after = InstructionCounter::ticks();
    cost.add(counter.between(before, after) - counter.between(start, before));
    if (answered && answer.id == canopen::kSdoResponse + kId)
      client_.response(answer.data, now_us_);
    discard();
  }

  // Other frames the node has to send.
  void discard() {
    for (hal::CanFrame frame; node_->device().offer(frame, now_us_);) {
      node_->device().taken(now_us_);
      if (frame.id == canopen::kSdoResponse + kId) client_.response(frame.data, now_us_);
    }
  }

  std::unique_ptr<node::Node> node_;
  canopen::SdoClient client_;
  std::uint64_t now_us_ = 0;
};

Bytes image_of(const MachineDescription& machine, std::size_t knots = bench::kKnots) {
  const auto tables = bench::make_tables(machine, knots);
  Bytes bytes(image_size(*tables));
  std::size_t written = 0;
  require(encode_image(*tables, {bytes.data(), bytes.size()}, written).ok(),
          "The tables do not become an image.");
  return bytes;
}

void measure_requests() {
  constexpr int kRounds = 100;
  constexpr std::size_t kKnotsOfEveryNode = 61;
  const Bytes ramp_ticks{20, 0, 0, 0};
  Services services;
  Cost upload;
  Cost download;
  Cost segment;
  for (int n = 0; n < kRounds; ++n) {
    services.upload({0x1018, 1}, upload);
    services.download({0x2200, 1}, ramp_ticks, download);
  }
  services.download({0x2110, 1}, image_of(kXyfzMachine, kKnotsOfEveryNode), segment);
  upload.print("upload_expedited");
  download.print("download_expedited");
  segment.print("download_of_image");
}

template <class Work>
std::uint32_t instructions_of(const Work& work) {
  const std::uint32_t before = hal::mps2::clock_ticks();
  require(work(), "An image was refused.");
  const std::uint64_t ticks = hal::mps2::clock_ticks() - before;
  return static_cast<std::uint32_t>(ticks * 5U / 8U);  // 40 ns of 64 ns each
}

void measure_image(const char* name, const MachineDescription& machine) {
  const Bytes image = image_of(machine);
  const auto view = std::make_unique<TablesView>();
  const auto unit =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(machine)});
  const auto& tool = machine.tool_point;
  const std::uint32_t check = instructions_of([&] {
    return check_image({image.data(), image.size()}, kDefaultKnots, *view).ok();
  });
  const std::uint32_t fold =
      instructions_of([&] { return unit->stage(*view, Vec3(tool[0], tool[1], tool[2]), 0).ok(); });
  put("image");
  put_field("machine", name);
  put_field("bytes", image.size());
  put_field("check", check);
  put_field("fold", fold);
  put('\n');
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  volcomp::hal::mps2::Clock::start();
  counter.start();
  measure_requests();
  measure_image("xyfz", volcomp::kXyfzMachine);
  measure_image("five_axis", volcomp::bench::kFiveAxis);
  if (!counter.exact()) stop("QEMU was not started with -icount shift=6,sleep=off.");
  return 0;
}
