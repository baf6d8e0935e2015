#include "tests/firmware/canopen/sdo_support.hpp"

#include <algorithm>

namespace volcomp::canopen::test {
namespace {

constexpr std::size_t kGuard = 16;
constexpr std::uint8_t kGuardByte = 0xA5;

}  // namespace

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes pattern(std::size_t size, unsigned seed) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(i * 37U + (i >> 8U) * 11U + seed);
  return bytes;
}

FakeObjects::Object& FakeObjects::add(ObjectId id, std::size_t capacity, Bytes value) {
  Object& object = objects_[{id.index, id.sub}];
  object.capacity = capacity;
  object.value = std::move(value);
  return object;
}

AbortCode FakeObjects::begin_upload(ObjectId id, Span<const std::uint8_t>& source) {
  const auto found = objects_.find({id.index, id.sub});
  if (found == objects_.end()) return AbortCode::no_object;
  source = {found->second.value.data(), found->second.value.size()};
  return found->second.on_upload;
}

AbortCode FakeObjects::begin_download(ObjectId id, std::size_t announced,
                                      Span<std::uint8_t>& sink) {
  EXPECT_FALSE(open_) << "two downloads at once";
  const auto found = objects_.find({id.index, id.sub});
  if (found == objects_.end()) return AbortCode::no_object;
  if (found->second.on_download != AbortCode::none) return found->second.on_download;
  memory_.assign(found->second.capacity + 2 * kGuard, kGuardByte);
  sink = {memory_.data() + kGuard, found->second.capacity};
  announced_ = announced;
  target_ = id;
  open_ = true;
  return AbortCode::none;
}

AbortCode FakeObjects::finish_download(ObjectId id, std::size_t size) {
  EXPECT_TRUE(open_ && id == target_);
  open_ = false;
  ++finished_;
  Object& object = at(id);
  if (object.on_finish != AbortCode::none) return object.on_finish;
  const std::uint8_t* const sink = memory_.data() + kGuard;
  object.value.assign(sink, sink + size);
  return AbortCode::none;
}

void FakeObjects::abandon_download(ObjectId id) {
  EXPECT_TRUE(open_ && id == target_);
  open_ = false;
  ++abandoned_;
}

bool FakeObjects::guards_intact() const {
  const auto intact = [](std::uint8_t byte) { return byte == kGuardByte; };
  return memory_.empty() || (std::all_of(memory_.begin(), memory_.begin() + kGuard, intact) &&
                             std::all_of(memory_.end() - kGuard, memory_.end(), intact));
}

std::vector<SdoData> responses(SdoServer& server) {
  std::vector<SdoData> all;
  SdoData frame{};
  while (all.size() <= kMostBlockSegments && server.response(frame))
    all.push_back(frame);
  return all;
}

std::vector<SdoData> ask(SdoServer& server, const SdoData& request, std::uint64_t now_us) {
  server.request(request, now_us);
  return responses(server);
}

bool Line::carry_requests() {
  bool moved = false;
  for (SdoData frame{}; client_.request(frame); moved = true) {
    ++frames_;
    if (!lose_request(frame)) server_.request(frame, now_us_);
  }
  return moved;
}

bool Line::carry_responses() {
  bool moved = false;
  for (SdoData frame{}; server_.response(frame); moved = true) {
    ++frames_;
    if (!lose_response(frame)) client_.response(frame, now_us_);
  }
  return moved;
}

void Line::run() {
  constexpr int kRounds = 100'000;
  for (int round = 0; round < kRounds; ++round) {
    const bool asked = carry_requests();
    const bool answered = carry_responses();
    if (asked || answered) continue;
    if (client_.state() != SdoClient::State::busy) return;
    now_us_ += 100'000;
    client_.poll(now_us_);
    server_.poll(now_us_);
  }
  FAIL() << "the transfer does not end";
}

}  // namespace volcomp::canopen::test
