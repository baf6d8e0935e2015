#pragma once
// Tells the service manager that started the process how it is (sd_notify(3): a datagram of lines
// to the socket that NOTIFY_SOCKET names). Without one every call does nothing.

#include <cstdint>
#include <string>

namespace volcomp::posix {

class ServiceManager {
 public:
  // Reads NOTIFY_SOCKET and WATCHDOG_USEC.
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  void ready(const std::string& status) const { tell("READY=1\nSTATUS=" + status); }
  void status(const std::string& status) const { tell("STATUS=" + status); }
  void stopping() const { tell("STOPPING=1"); }
  // From the loop that does the work, so that one that hangs is noticed: as often as a third of the
  // time that the manager waits.
  void alive(std::uint64_t now_us);

 private:
  void tell(const std::string& lines) const;

  int socket_ = -1;
  std::uint64_t period_us_ = 0;  // 0: nobody waits
  std::uint64_t told_us_ = 0;
};

}  // namespace volcomp::posix
