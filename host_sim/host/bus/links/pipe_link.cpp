#include "host_sim/host/bus/links/pipe_link.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using WallClock = std::chrono::steady_clock;

// A person starts the node in another window.
constexpr auto kOpenTimeout = std::chrono::seconds(30);
// A board is emulated at a fraction of its speed, on a computer that may be busy.
constexpr auto kTurnPatience = std::chrono::seconds(60);
constexpr int kPollInterval_ms = 100;
constexpr std::size_t kReadBytes = std::size_t{64} * 1024;

[[noreturn]] void refuse(const std::filesystem::path& folder, const std::string& what) {
  throw UserError(fmt::format("pipe:{}: {}", folder.string(), what));
}

void make_pipe(const std::filesystem::path& folder, const char* name) {
  constexpr mode_t kOwnerOnly = 0600;
  const std::filesystem::path path = folder / name;
  if (::mkfifo(path.c_str(), kOwnerOnly) == 0) return;
  const int error = errno;
  if (error != EEXIST)
    refuse(folder,
           fmt::format("{} cannot be made: {}", name, std::generic_category().message(error)));
  if (!std::filesystem::is_fifo(path)) refuse(folder, fmt::format("{} is no pipe", name));
}

void append(std::vector<std::uint8_t>& bytes, const hal::PipeBytes& record) {
  bytes.insert(bytes.end(), record.begin(), record.end());
}

}  // namespace

void make_frame_pipes(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) refuse(folder, "there is no such folder");
  make_pipe(folder, hal::kPipeToNode);
  make_pipe(folder, hal::kPipeFromNode);
}

PipeLink::PipeLink(const std::filesystem::path& folder, Watch watch)
    : folder_(folder), watch_(std::move(watch)) {
  make_frame_pipes(folder);
  open_pipes();
}

// --- opening

// Opening a pipe for writing succeeds only when another process has it open for reading.
void PipeLink::open_pipes() {
  const std::filesystem::path to_node = folder_ / hal::kPipeToNode;
  const std::filesystem::path from_node = folder_ / hal::kPipeFromNode;
  const auto begin = WallClock::now();
  while (true) {
    to_node_ = Descriptor(::open(to_node.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
    if (to_node_.open()) break;
    if (errno != ENXIO) fail("to_node cannot be opened");
    if (WallClock::now() - begin > kOpenTimeout)
      fail(fmt::format("no node has opened the other end within {} s", kOpenTimeout.count()));
    static_cast<void>(::poll(nullptr, 0, kPollInterval_ms));
    look();
  }
  from_node_ = Descriptor(::open(from_node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!from_node_.open()) fail("from_node cannot be opened");
}

// --- turns

bool PipeLink::send(const hal::CanFrame& frame) {
  append(outgoing_, hal::pipe_frame(frame));
  return true;
}

bool PipeLink::receive(hal::CanFrame& frame) {
  if (received_.empty()) return false;
  frame = received_.front();
  received_.pop_front();
  return true;
}

void PipeLink::turn(std::uint64_t now_us) {
  look();  // a node that always answers at once is never awaited
  now_us_ = now_us;
  append(outgoing_, hal::pipe_end_of_turn(now_us));
  write_turn();
  read_turn();
}

void PipeLink::quit() {
  append(outgoing_, hal::pipe_quit());
  write_turn();
}

void PipeLink::write_turn() {
  std::size_t written = 0;
  while (written < outgoing_.size()) {
    const ssize_t n = ::write(to_node_.number(), &outgoing_[written], outgoing_.size() - written);
    if (n > 0) {
      written += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      await(to_node_.number(), POLLOUT);
    } else if (errno != EINTR) {
      gone();
    }
  }
  outgoing_.clear();
}

void PipeLink::read_turn() {
  while (!take_records()) {
    await(from_node_.number(), POLLIN);
    const std::size_t had = incoming_.size();
    incoming_.resize(had + kReadBytes);
    const ssize_t n = ::read(from_node_.number(), &incoming_[had], kReadBytes);
    incoming_.resize(had + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n == 0) gone();
    if (n < 0 && errno != EAGAIN && errno != EINTR) gone();
  }
}

// Takes the whole records there are; true at the end of a turn.
bool PipeLink::take_records() {
  std::size_t taken = 0;
  bool ended = false;
  while (!ended && incoming_.size() - taken >= hal::kPipeRecordBytes) {
    hal::PipeBytes bytes{};
    std::copy_n(&incoming_[taken], bytes.size(), bytes.begin());
    taken += bytes.size();
    const hal::PipeRecord record = hal::pipe_record(bytes);
    switch (record.kind) {
      case hal::PipeRecord::Kind::frame:
        received_.push_back(record.frame);
        break;
      case hal::PipeRecord::Kind::end_of_turn:
        ended = true;
        break;
      case hal::PipeRecord::Kind::quit:
      case hal::PipeRecord::Kind::malformed:
        fail("what comes from the node is no record of a frame pipe");
    }
  }
  incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(taken));
  return ended;
}

// --- waiting

void PipeLink::await(int descriptor, short events) const {
  const auto begin = WallClock::now();
  while (true) {
    pollfd waiting{descriptor, events, 0};
    if (::poll(&waiting, 1, kPollInterval_ms) > 0) return;  // an end that is gone is reported, too
    look();
    if (WallClock::now() - begin > kTurnPatience)
      fail(fmt::format("the node has not answered for {} s", kTurnPatience.count()));
  }
}

void PipeLink::look() const {
  if (watch_) watch_(false);
}

void PipeLink::fail(const std::string& what) const { refuse(folder_, what); }

void PipeLink::gone() const {
  if (watch_) watch_(true);
  fail("the node at the other end is gone");
}

}  // namespace volcomp::host
