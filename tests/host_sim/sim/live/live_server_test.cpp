// The live page for clients that are slow, greedy or silent, over real sockets of the loopback
// interface. Nothing here is timed: every test waits for an event, at most kLongest.

#include "host_sim/sim/live/live_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace volcomp::sim {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kLongest{30};
constexpr std::chrono::hours kNever{1};

class Client {
 public:
  explicit Client(const LiveServer& server) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const std::string address = server.address();
    const std::string port = address.substr(address.rfind(':') + 1);
    host_ = "localhost:" + port.substr(0, port.size() - 1);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { static_cast<void>(::close(fd_)); }

  // False when the server has closed.
  [[nodiscard]] bool send(const std::string& text) const {
    return ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  [[nodiscard]] bool get(const std::string& path, const std::string& headers = {}) const {
    return send("GET " + path + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + headers + "\r\n");
  }
  // Whether the server closes within `wait`; what it has sent until then is dropped.
  [[nodiscard]] bool closed(milliseconds wait) const {
    const auto end = Clock::now() + wait;
    std::array<char, 4096> dropped{};
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
      pollfd one{fd_, POLLIN, 0};
      if (::poll(&one, 1, static_cast<int>(std::max<long>(left.count(), 0))) <= 0) return false;
      if (::recv(fd_, dropped.data(), dropped.size(), 0) <= 0) return true;
    }
  }
  // Everything until the server closes.
  [[nodiscard]] std::string answer() const {
    std::string all;
    std::array<char, 4096> part{};
    for (;;) {
      pollfd one{fd_, POLLIN, 0};
      if (::poll(&one, 1, static_cast<int>(milliseconds(kLongest).count())) <= 0) return all;
      const ssize_t count = ::recv(fd_, part.data(), part.size(), 0);
      if (count <= 0) return all;
      all.append(part.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  int fd_;
  std::string host_;
};

std::string body_of(const std::string& answer) {
  const auto end = answer.find("\r\n\r\n");
  return end == std::string::npos ? "" : answer.substr(end + 4);
}

std::unique_ptr<LiveServer> server(const LiveLimits& limits = {}) {
  return std::make_unique<LiveServer>(
      std::uint16_t{0}, [] { return std::string("{\"axes\":[]}"); }, limits);
}

// Sends `drop` again and again until the server closes.
bool cut_while_dripping(const Client& client, const std::string& drop) {
  const auto end = Clock::now() + kLongest;
  while (Clock::now() < end) {
    if (!client.send(drop) || client.closed(milliseconds(20))) return true;
  }
  return false;
}

// Ends the server beside this thread; true when that is over.
bool ends(std::unique_ptr<LiveServer>& server) {
  const auto over = std::async(std::launch::async, [&server] { server.reset(); });
  return over.wait_for(kLongest) == std::future_status::ready;
}

TEST(LiveServer, AnswersARequest) {
  const auto live = server();
  const Client client(*live);
  ASSERT_TRUE(client.get("/state.json"));
  EXPECT_EQ(body_of(client.answer()), "{\"axes\":[]}");
}

TEST(LiveServer, CutsAClientThatDripsTheHeaderOfItsRequest) {
  const auto live = server({milliseconds(300), kNever, 64 * 1024});
  const Client client(*live);
  ASSERT_TRUE(client.send("GET / HTTP/1.1\r\nX: "));
  EXPECT_TRUE(cut_while_dripping(client, "x"));
}

TEST(LiveServer, CutsAClientThatSendsNothing) {
  const auto live = server({milliseconds(300), kNever, 64 * 1024});
  const Client client(*live);
  EXPECT_TRUE(client.closed(kLongest));
}

TEST(LiveServer, CutsARequestOfEndlessHeaders) {
  const auto live = server({kNever, kNever, 64 * 1024});
  const Client client(*live);
  ASSERT_TRUE(client.send("GET / HTTP/1.1\r\n"));
  const std::string line = "X-Header: " + std::string(1000, 'x') + "\r\n";
  std::size_t sent = 0;
  while (sent < 64U * 1024 * 1024 && client.send(line)) {
    sent += line.size();
    if (client.closed(milliseconds(0))) break;
  }
  EXPECT_LT(sent, 64U * 1024 * 1024);
}

TEST(LiveServer, EndsWhileClientsDrip) {
  auto live = server({kNever, kNever, 64 * 1024});
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(std::make_unique<Client>(*live));
    ASSERT_TRUE(clients.back()->send("GET / HTTP/1.1\r\nX: "));
  }
  std::atomic<bool> dripping{true};
  std::thread drip([&] {
    while (dripping) {
      for (const auto& client : clients)
        static_cast<void>(client->send("x"));
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  auto over = std::async(std::launch::async, [&live] { live.reset(); });
  const bool has_ended = over.wait_for(kLongest) == std::future_status::ready;
  dripping = false;
  drip.join();
  EXPECT_TRUE(has_ended);
  over.wait();
  for (const auto& client : clients)
    EXPECT_TRUE(client->closed(kLongest));
}

TEST(LiveServer, EndsWhileAClientDoesNotReadItsAnswer) {
  auto live = server({kNever, kNever, 64 * 1024});
  live->offer_report(std::string(64U * 1024 * 1024, ' '), "{}");
  const Client client(*live);
  ASSERT_TRUE(client.get("/report.html"));
  EXPECT_TRUE(ends(live));
}

// RFC 9110, 14.2: a server may ignore the header field Range.
TEST(LiveServer, ManyRangesGetThePageOnce) {
  const auto live = server();
  live->offer_report(std::string(10'000, 'r'), "{}");
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 1500; ++i)
    ranges += ",0-";
  for (const std::string& header : {ranges + "\r\n", std::string("Range: bytes=0-9\r\n")}) {
    const Client client(*live);
    ASSERT_TRUE(client.get("/report.html", header));
    const std::string answer = client.answer();
    EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 200");
    EXPECT_EQ(body_of(answer), std::string(10'000, 'r'));
  }
}

}  // namespace
}  // namespace volcomp::sim
