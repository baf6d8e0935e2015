#include "host_sim/cli/drive_bus.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/host/bus/drive_check/drive_journal.hpp"
#include "host_sim/host/bus/drive_check/drive_ready.hpp"
#include "host_sim/host/bus/drive_check/drive_restore.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"

namespace volcomp::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kListen_us = 1'000'000;
constexpr std::size_t kLargestJournal = std::size_t{1} << 20U;

std::shared_ptr<host::FrameLink> open_link(const std::string& name) {
  if (name == "loopback")
    throw host::UserError(
        "loopback is a bus inside volcomp run; there is no drive to be met on it");
  return host::open_frame_link(name);
}

// Without a home there is none.
std::vector<fs::path> journals(const std::string& option) {
  if (!option.empty()) return {option};
  try {
    return host::journals_in(host::journal_folder());
  } catch (const host::UserError&) {
    return {};
  }
}

// Whose drive it is, if it can be read.
std::optional<host::JournalOwner> owner_of(const fs::path& path) {
  try {
    const auto content = host::read_journal(host::read_whole_file(path, kLargestJournal));
    if (content && !content->objects.empty()) return content->owner;
  } catch (const host::UserError&) {
  }
  return std::nullopt;
}

void tell_waiting(const fs::path& path, const host::JournalOwner& owner) {
  fmt::print(stderr,
             "volcomp: an interrupted command has left changes in node {} on {}: volcomp drive "
             "list --can {} puts them back ({})\n",
             owner.node, owner.bus, owner.bus, path.string());
}

void list_writes(const host::NotRestored& failed) {
  fmt::print(stderr, "these writes restore it, in this order:\n");
  for (const host::SdoWrite& write : failed.writes)
    fmt::print(stderr, "  {}\n", host::describe(write));
  fmt::print(stderr, "power cycle also restores: 1010h was not touched\n");
}

template <class Work>
void listing_failures(const Work& work) {
  try {
    work();
  } catch (const host::NotRestored& failed) {
    list_writes(failed);
    throw;
  }
}

void tell_notes(const host::Restored& restored) {
  for (const std::string& note : restored.notes)
    fmt::print(stderr, "volcomp: {}\n", note);
}

}  // namespace

DriveBus::DriveBus(const DriveBusOptions& options)
    : options_(options),
      link_(open_link(options.link)),
      heard_(host::listen(*link_, kListen_us, &identifiers_)) {
  restore_left_changes();
}

void DriveBus::restore_left_changes() const {
  for (const fs::path& path : journals(options_.journal)) {
    const auto owner = owner_of(path);
    if (owner && owner->bus != options_.link)
      tell_waiting(path, *owner);
    else
      restore(path);
  }
}

void DriveBus::restore(const fs::path& path) const {
  auto journal = host::DriveJournal::open(path);
  if (!journal) return;
  host::NodeClient client = client_of(journal->owner().node);
  const host::Interruption until_restored;
  listing_failures([&] {
    const host::Restored restored = host::restore(client, *journal);
    fmt::print(stderr, "volcomp: node {}: what an interrupted command had changed is as it was\n",
               client.node_id());
    tell_notes(restored);
  });
  until_restored.check();
}

host::NodeClient DriveBus::client_of(std::uint8_t node) const {
  const auto heard = heard_.find(node);
  if (heard != heard_.end() && heard->second.sdo_in_use)
    throw host::UserError(fmt::format(
        "somebody else reads or writes objects of node {}: try again when that is over", node));
  host::NodeClient client(node, host::LinkPump(link_));
  client.set_timeout_us(static_cast<std::uint64_t>(options_.timeout_ms * 1000.0));
  return client;
}

host::ForeignDrive read_with_bar(host::NodeClient& client) {
  ProgressBar bar;
  return host::read_drive(client, [&bar](std::size_t done, std::size_t most) {
    bar.show(static_cast<double>(done) / static_cast<double>(most), "reading objects");
  });
}

void DriveBus::require_ready(host::NodeClient& client, const host::ForeignDrive& drive) const {
  if (!drive.is_cia402())
    throw host::UserError(
        fmt::format("node {} is no CiA 402 drive: nothing is written to it", drive.node));
  const auto heard = heard_.find(drive.node);
  const auto state = heard == heard_.end() ? std::nullopt : heard->second.state;
  const auto id = static_cast<std::uint16_t>(canopen::kHeartbeat + drive.node);
  host::require_ready(client, drive, state, [this, id] { return link_->send_remote(id, 1); });
}

void DriveBus::change(host::NodeClient& client,
                      const std::function<void(host::DriveChanges& changes)>& work) const {
  const fs::path path =
      options_.journal.empty()
          ? host::journal_folder() / host::journal_name(options_.link, client.node_id())
          : fs::path(options_.journal);
  const host::Interruption interruption;
  host::DriveChanges changes(client, path,
                             {options_.link, client.node_id(), host::read_identity(client)},
                             [&interruption] { interruption.check(); });
  listing_failures([&] { work(changes); });
  interruption.check();
}

void tell_left_changes(const std::string& journal_option) {
  for (const fs::path& path : journals(journal_option)) {
    if (const auto owner = owner_of(path)) tell_waiting(path, *owner);
  }
}

void require_consent(const std::string& question, bool given) {
  if (given) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw host::UserError("objects of a drive are written only on consent: --yes");
  fmt::print(stderr, "{}\nType yes to go on: ", question);
  static_cast<void>(std::fflush(stderr));
  std::array<char, 16> line{};
  const bool answered = std::fgets(line.data(), line.size(), stdin) != nullptr;
  if (!answered || std::string(line.data()) != "yes\n")
    throw host::UserError("without consent nothing was written");
}

void add_journal_option(CLI::App& command, std::string& journal) {
  command.add_option("--journal", journal,
                     "File for old values of the drive instead of one in $XDG_STATE_HOME/volcomp");
}

}  // namespace volcomp::cli
