#include "hal/linux/node_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace volcomp::hal {
namespace {

constexpr mode_t kOwnerOnly = 0600;

OpenStatus failure(OpenResult result) { return {result, errno}; }

bool is_pipe(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISFIFO(status.st_mode);
}

OpenStatus make_pipe(int folder, const char* name) {
  const bool there = ::mkfifoat(folder, name, kOwnerOnly) == 0 || errno == EEXIST;
  return there ? OpenStatus{} : failure(OpenResult::failed);
}

void close_one(int& descriptor) {
  if (descriptor >= 0) static_cast<void>(::close(descriptor));
  descriptor = -1;
}

}  // namespace

// The end that reads can be opened before anybody writes.
OpenStatus NodePipe::open(const char* folder) {
  close();
  folder_ = ::open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) {
    const bool missing = errno == ENOENT || errno == ENOTDIR;
    return failure(missing ? OpenResult::no_such_folder : OpenResult::failed);
  }
  if (const OpenStatus s = make_pipe(folder_, kPipeToNode); !s.ok()) return s;
  if (const OpenStatus s = make_pipe(folder_, kPipeFromNode); !s.ok()) return s;
  to_node_ = ::openat(folder_, kPipeToNode, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (to_node_ < 0) return failure(OpenResult::failed);
  return is_pipe(to_node_) ? OpenStatus{} : OpenStatus{OpenResult::not_a_pipe, 0};
}

void NodePipe::close() {
  close_one(folder_);
  close_one(to_node_);
  close_one(from_node_);
  for (CanFrame dropped; received_.pop(dropped);) {
  }
  now_us_ = 0;
  ended_ = false;
}

bool NodePipe::begin_turn(std::uint32_t timeout_us) {
  while (!ended_ && await_data(timeout_us)) {
    PipeRecord record;
    if (!read_record(record)) continue;
    if (record.kind == PipeRecord::Kind::end_of_turn) {
      now_us_ = record.sender_us;
      ended_ = !open_answer();
      return !ended_;
    }
    const bool frame = record.kind == PipeRecord::Kind::frame;
    if (!frame || !received_.push(record.frame)) ended_ = true;
  }
  return false;
}

void NodePipe::end_turn() { static_cast<void>(write_record(pipe_end_of_turn(now_us_))); }

// The host opens both pipes before it writes.
bool NodePipe::open_answer() {
  if (from_node_ >= 0) return true;
  from_node_ = ::openat(folder_, kPipeFromNode, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (from_node_ < 0 || !is_pipe(from_node_)) return false;
  return ::fcntl(from_node_, F_SETFL, 0) == 0;  // a full pipe makes us wait
}

bool NodePipe::await_data(std::uint32_t timeout_us) const {
  pollfd waiting{to_node_, POLLIN, 0};
  timespec timeout{};
  timeout.tv_sec = timeout_us / 1'000'000U;
  timeout.tv_nsec = static_cast<long>(timeout_us % 1'000'000U) * 1'000;
  return ::ppoll(&waiting, 1, &timeout, nullptr) > 0;
}

bool NodePipe::read_record(PipeRecord& record) {
  PipeBytes bytes{};
  const ssize_t n = ::read(to_node_, bytes.data(), bytes.size());
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  ended_ = n != ssize_t{kPipeRecordBytes};
  record = pipe_record(bytes);
  return !ended_;
}

bool NodePipe::write_record(const PipeBytes& bytes) {
  while (!ended_) {
    const ssize_t n = ::write(from_node_, bytes.data(), bytes.size());
    if (n == ssize_t{kPipeRecordBytes}) return true;
    if (n >= 0 || errno != EINTR) ended_ = true;
  }
  return false;
}

}  // namespace volcomp::hal
