#pragma once
// Objects that record what an SDO server does with them, and a line between a client and a server.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "firmware/canopen/sdo_client.hpp"
#include "firmware/canopen/sdo_server.hpp"

namespace volcomp::canopen::test {

// A domain, as table images are.
constexpr ObjectId kObject{0x2110, 0x01};

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text);
// Bytes that all differ from their neighbours, other ones for every seed.
Bytes pattern(std::size_t size, unsigned seed = 1);

class FakeObjects final : public ObjectAccess {
 public:
  struct Object {
    Bytes value;
    std::size_t capacity = 0;
    AbortCode on_upload = AbortCode::none;
    AbortCode on_download = AbortCode::none;
    AbortCode on_finish = AbortCode::none;
  };

  Object& add(ObjectId id, std::size_t capacity, Bytes value = {});
  Object& at(ObjectId id) { return objects_.at({id.index, id.sub}); }

  AbortCode begin_upload(ObjectId id, Span<const std::uint8_t>& source) override;
  AbortCode begin_download(ObjectId id, std::size_t announced, Span<std::uint8_t>& sink) override;
  AbortCode finish_download(ObjectId id, std::size_t size) override;
  void abandon_download(ObjectId id) override;

  // Whether only the sink was written so far.
  [[nodiscard]] bool guards_intact() const;
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] int finished() const { return finished_; }
  [[nodiscard]] int abandoned() const { return abandoned_; }
  [[nodiscard]] std::size_t announced() const { return announced_; }

 private:
  std::map<std::pair<std::uint16_t, std::uint8_t>, Object> objects_;
  Bytes memory_;  // guard, sink, guard
  ObjectId target_{};
  std::size_t announced_ = 0;
  bool open_ = false;
  int finished_ = 0;
  int abandoned_ = 0;
};

// What the server sends after one request.
std::vector<SdoData> ask(SdoServer& server, const SdoData& request, std::uint64_t now_us = 0);
std::vector<SdoData> responses(SdoServer& server);

// Carries frames both ways until the client is no longer busy; when nothing moves, time passes.
class Line {
 public:
  using Loss = std::function<bool(const SdoData&)>;

  Line(SdoClient& client, SdoServer& server) : client_(client), server_(server) {}

  // Every frame in one direction is lost for which this returns true.
  Loss lose_request = [](const SdoData&) { return false; };
  Loss lose_response = [](const SdoData&) { return false; };

  void run();
  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }
  [[nodiscard]] std::size_t frames() const { return frames_; }

 private:
  [[nodiscard]] bool carry_requests();
  [[nodiscard]] bool carry_responses();

  SdoClient& client_;
  SdoServer& server_;
  std::uint64_t now_us_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace volcomp::canopen::test
