#include "tests/hal/system_calls.hpp"

// The linker's names for a call and for what it was before: --wrap of GNU ld and of lld.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wreserved-identifier"
#endif

extern "C" {
int __real_socket(int domain, int type, int protocol);
int __real_ioctl(int fd, unsigned long request, ...);
int __real_setsockopt(int fd, int level, int name, const void* value, socklen_t size);
int __real_bind(int fd, const sockaddr* address, socklen_t size);
ssize_t __real_send(int fd, const void* bytes, size_t size, int flags);
ssize_t __real_recvmsg(int fd, msghdr* message, int flags);
int __real_fstat(int fd, struct stat* info);
int __real_flock(int fd, int operation);
int __real_ftruncate(int fd, off_t size);
int __real_fdatasync(int fd);
int __real_fsync(int fd);
int __real_open(const char* path, int flags, ...);
ssize_t __real_pwrite(int fd, const void* bytes, size_t size, off_t at);
int __real_mkfifoat(int folder, const char* name, mode_t mode);
int __real_openat(int folder, const char* name, int flags, ...);
ssize_t __real_read(int fd, void* bytes, size_t size);
ssize_t __real_write(int fd, const void* bytes, size_t size);
}

namespace volcomp::test {
namespace {

const SystemCalls* answers = nullptr;

// The answer of the test, or that of the kernel.
template <auto Member, class Kernel, class... Arguments>
auto ask(Kernel kernel, Arguments... arguments) {
  if (answers != nullptr && answers->*Member) return (answers->*Member)(arguments...);
  return kernel();
}

}  // namespace

SystemCalls::SystemCalls() { answers = this; }
SystemCalls::~SystemCalls() { answers = nullptr; }

ssize_t kernel_pwrite(int fd, const void* bytes, std::size_t size, off_t at) {
  return __real_pwrite(fd, bytes, size, at);
}

int kernel_open(const char* path, int flags) { return __real_open(path, flags, 0600); }

extern "C" {

int __wrap_socket(int domain, int type, int protocol) {
  return ask<&SystemCalls::socket>([&] { return __real_socket(domain, type, protocol); }, domain,
                                   type, protocol);
}
int __wrap_ioctl(int fd, unsigned long request, void* argument) {
  return ask<&SystemCalls::ioctl>([&] { return __real_ioctl(fd, request, argument); }, fd, request,
                                  argument);
}
int __wrap_setsockopt(int fd, int level, int name, const void* value, socklen_t size) {
  return ask<&SystemCalls::setsockopt>(
      [&] { return __real_setsockopt(fd, level, name, value, size); }, fd, level, name, value,
      size);
}
int __wrap_bind(int fd, const sockaddr* address, socklen_t size) {
  return ask<&SystemCalls::bind>([&] { return __real_bind(fd, address, size); }, fd, address);
}
ssize_t __wrap_send(int fd, const void* bytes, size_t size, int flags) {
  return ask<&SystemCalls::send>([&] { return __real_send(fd, bytes, size, flags); }, fd, bytes,
                                 size);
}
ssize_t __wrap_recvmsg(int fd, msghdr* message, int flags) {
  return ask<&SystemCalls::recvmsg>([&] { return __real_recvmsg(fd, message, flags); }, fd,
                                    message);
}
int __wrap_fstat(int fd, struct stat* info) {
  return ask<&SystemCalls::fstat>([&] { return __real_fstat(fd, info); }, fd, info);
}
int __wrap_flock(int fd, int operation) {
  return ask<&SystemCalls::flock>([&] { return __real_flock(fd, operation); }, fd, operation);
}
int __wrap_ftruncate(int fd, off_t size) {
  return ask<&SystemCalls::ftruncate>([&] { return __real_ftruncate(fd, size); }, fd, size);
}
int __wrap_fdatasync(int fd) {
  return ask<&SystemCalls::fdatasync>([&] { return __real_fdatasync(fd); }, fd);
}
int __wrap_fsync(int fd) {
  return ask<&SystemCalls::fsync>([&] { return __real_fsync(fd); }, fd);
}
int __wrap_open(const char* path, int flags, mode_t mode) {
  return ask<&SystemCalls::open>([&] { return __real_open(path, flags, mode); }, path, flags);
}
ssize_t __wrap_pwrite(int fd, const void* bytes, size_t size, off_t at) {
  return ask<&SystemCalls::pwrite>([&] { return __real_pwrite(fd, bytes, size, at); }, fd, bytes,
                                   size, at);
}
int __wrap_mkfifoat(int folder, const char* name, mode_t mode) {
  return ask<&SystemCalls::mkfifoat>([&] { return __real_mkfifoat(folder, name, mode); }, folder,
                                     name);
}
int __wrap_openat(int folder, const char* name, int flags, mode_t mode) {
  return ask<&SystemCalls::openat>([&] { return __real_openat(folder, name, flags, mode); }, folder,
                                   name);
}
ssize_t __wrap_read(int fd, void* bytes, size_t size) {
  return ask<&SystemCalls::read>([&] { return __real_read(fd, bytes, size); }, fd, bytes, size);
}
ssize_t __wrap_write(int fd, const void* bytes, size_t size) {
  return ask<&SystemCalls::write>([&] { return __real_write(fd, bytes, size); }, fd, bytes, size);
}

}  // extern "C"

}  // namespace volcomp::test

#ifdef __clang__
#pragma clang diagnostic pop
#endif
