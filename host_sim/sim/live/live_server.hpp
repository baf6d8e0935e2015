#pragma once
// The live page over HTTP, for browsers on this computer only: bound to 127.0.0.1, and a request
// that was meant for another host is refused, whoever sent it. Reading is all one can do.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace volcomp::sim {

class LiveServer {
 public:
  // `state`: the JSON of the page, asked for by other threads until the server is gone. Port 0:
  // any that is free. Throws UserError when the port cannot be had.
  LiveServer(std::uint16_t port, std::function<std::string()> state);
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;
  ~LiveServer();  // answers what is being asked, then listens no more

  [[nodiscard]] std::string address() const;  // "http://127.0.0.1:8470/"

  // The report of the run as it would be written to files; from then on beside the live page.
  void offer_report(const std::string& html, const std::string& json);

  // Whether somebody asks for the state again and again, and how often it was told altogether.
  [[nodiscard]] bool watched() const;
  [[nodiscard]] std::uint64_t told() const;

 private:
  class Pages;
  std::unique_ptr<Pages> pages_;
};

}  // namespace volcomp::sim
