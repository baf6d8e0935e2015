#pragma once
// The live page over HTTP, for browsers on this computer only: bound to 127.0.0.1, and a request
// for another host is refused (host_header.hpp). The server is read-only.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace volcomp::sim {

// What one connection may take. A browser on the same computer needs milliseconds and 1 KiB.
struct LiveLimits {
  std::chrono::milliseconds request{5'000};  // for all of the request, from when a thread takes it
  std::chrono::milliseconds answer{30'000};  // for all of the answer
  std::size_t request_bytes = std::size_t{64} * 1024;
};

class LiveServer {
 public:
  // `state`: the JSON of the page, called by other threads until the server is gone. Port 0: any
  // that is free. Throws UserError when the port cannot be had.
  LiveServer(std::uint16_t port, std::function<std::string()> state, const LiveLimits& limits = {});
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;
  ~LiveServer();  // closes every connection, whatever its client does, and listens no more

  [[nodiscard]] std::string address() const;  // "http://127.0.0.1:8470/"

  // The report of the run as it would be written to files; from then on beside the live page.
  void offer_report(const std::string& html, const std::string& json);

  // Whether a page polls the state, and how often the state has been sent altogether.
  [[nodiscard]] bool watched() const;
  [[nodiscard]] std::uint64_t told() const;

 private:
  class Pages;
  std::unique_ptr<Pages> pages_;
};

}  // namespace volcomp::sim
