#include "host_sim/host/bus/links/serial_device.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr const char* kDefaultBaud = "115200";

// B0 (hang up) where there is no such rate.
speed_t speed_of(const std::string& baud) {
  static constexpr std::array<std::pair<const char*, speed_t>, 10> kSpeeds{{{"9600", B9600},
                                                                            {"19200", B19200},
                                                                            {"38400", B38400},
                                                                            {"57600", B57600},
                                                                            {kDefaultBaud, B115200},
                                                                            {"230400", B230400},
                                                                            {"460800", B460800},
                                                                            {"921600", B921600},
                                                                            {"1000000", B1000000},
                                                                            {"2000000", B2000000}}};
  for (const auto& [text, speed] : kSpeeds) {
    if (baud == text) return speed;
  }
  return B0;
}

}  // namespace

SerialDevice::SerialDevice(const std::string& name) : path_(name.substr(0, name.rfind('@'))) {
  const std::string baud = path_ == name ? kDefaultBaud : name.substr(path_.size() + 1);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (!std::filesystem::exists(status)) fail_for(ENOENT);
  if (std::filesystem::is_socket(status)) {
    connect_socket();
  } else {
    open_terminal(baud);
  }
}

void SerialDevice::connect_socket() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path_.size() >= sizeof address.sun_path) fail_for(ENAMETOOLONG);
  std::memcpy(address.sun_path, path_.data(), path_.size());
  device_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  if (!device_.open() || ::connect(device_.number(), generic, sizeof address) != 0) fail_for(errno);
  static_cast<void>(::fcntl(device_.number(), F_SETFL, O_NONBLOCK));
}

void SerialDevice::open_terminal(const std::string& baud) {
  device_ = Descriptor(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!device_.open()) fail_for(errno);
  if (::isatty(device_.number()) == 0) fail("is neither a serial line nor a socket");
  set_raw(baud);
}

void SerialDevice::set_raw(const std::string& baud) {
  const speed_t speed = speed_of(baud);
  if (speed == B0) fail("there is no rate of " + baud + " baud");
  termios settings{};
  if (::tcgetattr(device_.number(), &settings) != 0) fail_for(errno);
  ::cfmakeraw(&settings);
  settings.c_cflag |= tcflag_t{CLOCAL} | tcflag_t{CREAD};
  if (::cfsetspeed(&settings, speed) != 0) fail_for(errno);
  if (::tcsetattr(device_.number(), TCSANOW, &settings) != 0) fail_for(errno);
}

std::size_t SerialDevice::write(std::string_view bytes) {
  const ssize_t n = ::write(device_.number(), bytes.data(), bytes.size());
  if (n >= 0) return static_cast<std::size_t>(n);
  if (errno != EAGAIN && errno != EINTR) fail("the other end is gone");
  return 0;
}

std::string SerialDevice::read() {
  std::array<char, 4096> bytes{};
  const ssize_t n = ::read(device_.number(), bytes.data(), bytes.size());
  if (n > 0) return {bytes.data(), static_cast<std::size_t>(n)};
  // A terminal whose other side is closed reports an error, a socket the end.
  if (n == 0 || (errno != EAGAIN && errno != EINTR)) fail("the other end is gone");
  return {};
}

void SerialDevice::wait(std::uint32_t timeout_us) const {
  pollfd waiting{device_.number(), POLLIN, 0};
  timespec timeout{};
  timeout.tv_sec = timeout_us / 1'000'000U;
  timeout.tv_nsec = static_cast<long>(timeout_us % 1'000'000U) * 1'000;
  static_cast<void>(::ppoll(&waiting, 1, &timeout, nullptr));
}

void SerialDevice::fail(const std::string& what) const { throw UserError(path_ + ": " + what); }

void SerialDevice::fail_for(int error) const { fail(std::generic_category().message(error)); }

}  // namespace volcomp::host
