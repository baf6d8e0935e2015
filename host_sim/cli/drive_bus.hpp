#pragma once
// What every `volcomp drive` command on a bus does first: listen, and put back what an interrupted
// one has left in a drive.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "host_sim/cli/commands.hpp"
#include "host_sim/host/bus/drive_check/drive_changes.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"
#include "host_sim/host/bus/drive_check/heard_nodes.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::cli {

struct DriveBusOptions {
  std::string link;
  std::string journal;  // --journal; empty: in the folder of the user
  double timeout_ms = 1000.0;
};

class DriveBus {
 public:
  // Opens the link, listens for a second and restores. Throws UserError, also when something could
  // not be restored: the writes that do it stand on standard error then.
  explicit DriveBus(const DriveBusOptions& options);

  [[nodiscard]] const std::shared_ptr<host::FrameLink>& link() const { return link_; }
  [[nodiscard]] host::HeardNodes& heard() { return heard_; }
  [[nodiscard]] const std::set<std::uint16_t>& identifiers() const { return identifiers_; }

  // Throws UserError when somebody else uses the SDO server of the node: a request beside his would
  // break his transfer.
  [[nodiscard]] host::NodeClient client_of(std::uint8_t node) const;
  // Throws UserError unless the drive is PRE-OPERATIONAL and not enabled.
  void require_ready(host::NodeClient& client, const host::ForeignDrive& drive) const;
  // Runs work that changes the drive for a while: signals are noted, and end it after everything is
  // back. What could not be restored is listed on standard error.
  void change(host::NodeClient& client,
              const std::function<void(host::DriveChanges& changes)>& work) const;

 private:
  void restore_left_changes() const;
  void restore(const std::filesystem::path& path) const;

  DriveBusOptions options_;
  std::shared_ptr<host::FrameLink> link_;
  std::set<std::uint16_t> identifiers_;
  host::HeardNodes heard_;
};

// Reads all objects, with a bar on a terminal.
[[nodiscard]] host::ForeignDrive read_with_bar(host::NodeClient& client);

// Tells on standard error of journals that wait for a drive on a bus.
void tell_left_changes(const std::string& journal_option);

// Asks on the terminal; throws UserError without a "yes". `given`: --yes.
void require_consent(const std::string& question, bool given);

void add_journal_option(CLI::App& command, std::string& journal);

}  // namespace volcomp::cli
