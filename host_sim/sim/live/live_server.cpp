#include "host_sim/sim/live/live_server.hpp"

#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/page/page.hpp"
#include "host_sim/sim/live/host_header.hpp"
#include "host_sim/sim/live/live_connection.hpp"

namespace volcomp::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kThreads = 4;
constexpr std::chrono::seconds kWatching{2};  // a page polls four times a second

constexpr const char* kPolicy = "Content-Security-Policy";
// The live page has its script and style in files of their own; charts set styles of elements.
constexpr const char* kLivePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
    "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
// The report is one file.
constexpr const char* kReportPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

// The library's default would let a second program share the port and take half of the requests.
void socket_options(int socket) {
  const int yes = 1;
  static_cast<void>(::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes));
}

// Becomes readable for every connection at once, and stays so.
class StopSignal {
 public:
  StopSignal() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw host::UserError(fmt::format("--serve: {}", std::strerror(errno)));
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal() { static_cast<void>(::close(fd_)); }

  [[nodiscard]] int fd() const { return fd_; }
  void raise() const { static_cast<void>(::eventfd_write(fd_, 1)); }

 private:
  int fd_;
};

// One request a connection.
class Server : public httplib::Server {
 public:
  explicit Server(const LiveLimits& limits) : limits_(limits) {}

  void stop_now() {
    stop_.raise();
    stop();
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    LiveConnection connection(socket, stop_.fd(), limits_);
    bool closed = false;
    // A server may ignore Range (RFC 9110, 14.2); a list of ranges would make an answer larger than
    // its page.
    return process_request(connection, true, closed,
                           [](httplib::Request& request) { request.ranges.clear(); });
  }

  LiveLimits limits_;
  StopSignal stop_;
};

}  // namespace

class LiveServer::Pages {
 public:
  Pages(std::uint16_t port, std::function<std::string()> state, const LiveLimits& limits)
      : state_(std::move(state)), server_(limits) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_socket_options(socket_options);
    server_.set_payload_max_length(0);
    server_.set_default_headers({{"Accept-Ranges", "none"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cache-Control", "no-store"}});
    add_pages();
    port_ = port == 0 ? server_.bind_to_any_port(kLoopback) : port;
    if (port_ <= 0 || (port != 0 && !server_.bind_to_port(kLoopback, port)))
      throw host::UserError(fmt::format("--serve: port {} of this computer cannot be had", port));
    const host::SignalsHeld not_for_the_listener;
    listener_ = std::thread([this] {
      server_.listen_after_bind();
      over_ = true;
    });
  }

  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  ~Pages() {
    // stop() does nothing before the thread has begun to listen.
    while (!server_.is_running() && !over_)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    server_.stop_now();
    listener_.join();
  }

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::uint64_t told() const { return told_; }
  [[nodiscard]] bool watched() const {
    return told_ > 0 && Clock::now().time_since_epoch() - last_asked_.load() < kWatching;
  }

  void offer(const std::string& html, const std::string& json) {
    const std::lock_guard lock(report_mutex_);
    report_html_ = html;
    report_json_ = json;
  }

 private:
  using Request = httplib::Request;
  using Response = httplib::Response;

  void add_pages() {
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
      return refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                        : httplib::Server::HandlerResponse::Unhandled;
    });
    // Errors, too.
    server_.set_post_routing_handler([](const Request&, Response& response) {
      if (!response.has_header(kPolicy)) response.set_header(kPolicy, kLivePolicy);
    });
    add("/", host::live_page, "text/html");
    add("/live.js", host::live_script, "text/javascript");
    add("/live.css", host::live_style, "text/css");
    server_.Get("/state.json", [this](const Request&, Response& response) {
      response.set_content(state_(), "application/json");
      last_asked_ = Clock::now().time_since_epoch();
      ++told_;
    });
    server_.Get("/report.html", [this](const Request&, Response& response) {
      give_report(response, report_html_, "text/html; charset=utf-8");
      response.set_header(kPolicy, kReportPolicy);
    });
    server_.Get("/report.json", [this](const Request&, Response& response) {
      give_report(response, report_json_, "application/json");
    });
  }

  // Before anything of a body is read.
  [[nodiscard]] bool refused(const Request& request, Response& response) const {
    if (request.get_header_value_count("Host") != 1 ||
        !names_this_server(request.get_header_value("Host"), port_)) {
      response.status = 421;
      response.set_content("This page is for http://localhost and http://127.0.0.1 only.\n",
                           "text/plain");
      return true;
    }
    if (request.method == "GET" || request.method == "HEAD") return false;
    response.status = 405;
    response.set_header("Allow", "GET, HEAD");
    return true;
  }

  void add(const char* path, std::string (*page)(), const char* type) {
    server_.Get(path, [page, type](const Request&, Response& response) {
      response.set_content(page(), fmt::format("{}; charset=utf-8", type));
    });
  }

  void give_report(Response& response, const std::string& text, const char* type) {
    const std::lock_guard lock(report_mutex_);
    if (!text.empty()) {
      response.set_content(text, type);
      return;
    }
    response.status = 404;
    response.set_content("The run has not ended yet.\n", "text/plain");
  }

  std::function<std::string()> state_;
  Server server_;
  int port_ = 0;
  std::atomic<std::uint64_t> told_{0};
  std::atomic<Clock::duration> last_asked_{Clock::duration::zero()};
  std::mutex report_mutex_;
  std::string report_html_;
  std::string report_json_;
  std::atomic<bool> over_{false};
  std::thread listener_;
};

LiveServer::LiveServer(std::uint16_t port, std::function<std::string()> state,
                       const LiveLimits& limits)
    : pages_(std::make_unique<Pages>(port, std::move(state), limits)) {}

LiveServer::~LiveServer() = default;

std::string LiveServer::address() const {
  return fmt::format("http://{}:{}/", kLoopback, pages_->port());
}

void LiveServer::offer_report(const std::string& html, const std::string& json) {
  pages_->offer(html, json);
}

bool LiveServer::watched() const { return pages_->watched(); }
std::uint64_t LiveServer::told() const { return pages_->told(); }

}  // namespace volcomp::sim
