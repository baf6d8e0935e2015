#pragma once
// System calls of hal/linux, answered by a test instead of the kernel: the linker leads these calls
// of the test program here (volcomp_answer_system_calls in tests/CMakeLists.txt). A call without an
// answer goes to the kernel.
//
//   SystemCalls calls;
//   calls.fdatasync = [](int) { return failing(EIO); };

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>

#include <cerrno>
#include <functional>

namespace volcomp::test {

// As long as it lives; one at a time.
class SystemCalls {
 public:
  SystemCalls();
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;
  ~SystemCalls();

  std::function<int(int domain, int type, int protocol)> socket;
  std::function<int(int fd, unsigned long request, void* argument)> ioctl;
  std::function<int(int fd, int level, int name, const void* value, socklen_t size)> setsockopt;
  std::function<int(int fd, const sockaddr* address)> bind;
  std::function<ssize_t(int fd, const void* bytes, std::size_t size)> send;
  std::function<ssize_t(int fd, msghdr* message)> recvmsg;
  std::function<int(int fd, struct stat* info)> fstat;
  std::function<int(int fd, int operation)> flock;
  std::function<int(int fd, off_t size)> ftruncate;
  std::function<int(int fd)> fdatasync;
  std::function<int(int fd)> fsync;
  std::function<int(const char* path, int flags)> open;
  std::function<ssize_t(int fd, const void* bytes, std::size_t size, off_t at)> pwrite;
  std::function<int(int folder, const char* name)> mkfifoat;
  std::function<int(int folder, const char* name)> openat;
  std::function<ssize_t(int fd, void* bytes, std::size_t size)> read;
  std::function<ssize_t(int fd, const void* bytes, std::size_t size)> write;
};

// What a call that fails returns, errno set.
inline int failing(int error) {
  errno = error;
  return -1;
}

// The kernel's own, past the answers.
ssize_t kernel_pwrite(int fd, const void* bytes, std::size_t size, off_t at);
int kernel_open(const char* path, int flags);

}  // namespace volcomp::test
