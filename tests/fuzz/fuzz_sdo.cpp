// Any sequence of SDO requests and pauses: the server writes only into the sinks it was given, only
// while a download is open, answers a bounded number of frames, and works again after a reset.
//
// The input is cut into 8-byte requests. FFh in front, which is no command, makes time pass
// instead.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/sdo_server.hpp"

namespace volcomp::canopen {
namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

constexpr ObjectId kValue{0x1000, 0};
constexpr ObjectId kString{0x1008, 0};
constexpr ObjectId kDomain{0x2110, 1};

// The sink is a block of its own, as large as the object, so that the address sanitizer sees the
// first byte beyond it, and one written after its release.
class Objects final : public ObjectAccess {
 public:
  [[nodiscard]] bool open() const { return !sink_.empty(); }

 private:
  AbortCode begin_upload(ObjectId object, Span<const std::uint8_t>& source) override {
    require(!open());
    source_ = value(object);
    source = {source_.data(), source_.size()};
    return capacity(object) == 0 ? AbortCode::no_object : AbortCode::none;
  }
  AbortCode begin_download(ObjectId object, std::size_t announced,
                           Span<std::uint8_t>& sink) override {
    require(!open());
    if (capacity(object) == 0) return AbortCode::no_object;
    // The domain leaves the judgement of the size to the server.
    if (announced > capacity(object) && object != kDomain) return AbortCode::too_long;
    target_ = object;
    announced_ = announced;
    sink_ = std::vector<std::uint8_t>(capacity(object));
    sink = {sink_.data(), sink_.size()};
    return AbortCode::none;
  }
  AbortCode finish_download(ObjectId object, std::size_t size) override {
    require(open() && object == target_ && size <= sink_.size());
    require(announced_ == 0 || size == announced_);
    sink_.resize(size);
    std::vector<std::uint8_t> bytes;
    bytes.swap(sink_);
    if (object == kValue && size != 4) return AbortCode::wrong_length;
    if (object == kDomain) domain_.swap(bytes);
    return AbortCode::none;
  }
  void abandon_download(ObjectId object) override {
    require(open() && object == target_);
    std::vector<std::uint8_t>().swap(sink_);
  }

  static std::size_t capacity(ObjectId object) {
    if (object == kValue) return 4;
    if (object == kString) return 24;
    return object == kDomain ? 2048 : 0;
  }
  [[nodiscard]] std::vector<std::uint8_t> value(ObjectId object) const {
    if (object == kString) return string_;
    if (object == kDomain) return domain_;
    return {1, 2, 3, 4};
  }

  ObjectId target_{};
  std::size_t announced_ = 0;
  std::vector<std::uint8_t> sink_;
  std::vector<std::uint8_t> source_;
  std::vector<std::uint8_t> string_ = std::vector<std::uint8_t>(17, 's');
  std::vector<std::uint8_t> domain_ = std::vector<std::uint8_t>(2048, 'd');
};

std::size_t take_responses(SdoServer& server, SdoData& last) {
  constexpr std::size_t kMost = 128;
  std::size_t count = 0;
  while (server.response(last))
    require(++count <= kMost);
  return count;
}

void run(const std::uint8_t* data, std::size_t size) {
  Objects objects;
  SdoServer server{objects};
  std::uint64_t now_us = 0;
  SdoData frame{};
  for (std::size_t at = 0; at + frame.size() <= size; at += frame.size()) {
    std::copy_n(data + at, frame.size(), frame.begin());
    if (frame[0] == 0xFF) {
      now_us += load_le(frame.data() + 1, 3);
      server.poll(now_us);
    } else {
      server.request(frame, now_us);
    }
    // Now and then the bus has no room for responses before the next request.
    if (frame[7] != 0xFE) take_responses(server, frame);
  }
  server.reset();
  require(!objects.open());
  require(take_responses(server, frame) == 0);
  server.request({0x40, 0x00, 0x10, 0x00}, now_us);
  require(take_responses(server, frame) == 1);
  require(frame == SdoData{0x43, 0x00, 0x10, 0x00, 1, 2, 3, 4});
}

}  // namespace
}  // namespace volcomp::canopen

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  volcomp::canopen::run(data, size);
  return 0;
}
