#pragma once
// Says in words which way of the compensation node fits a drive and what the drive lacks for it.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware/node/ways.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

using node::Way;
[[nodiscard]] const char* words_of(Way way);

// One line of the check.
struct DriveFact {
  std::string key;      // of the JSON
  std::string title;    // for people
  std::string value;    // a few words
  std::string objects;  // that say so, with what they hold
};

struct DriveCheck {
  std::string name;  // of the drive, with its firmware
  std::uint8_t node = 1;
  std::vector<DriveFact> facts;
  Way best = Way::none;               // that the drive can take
  std::optional<bool> best_is_sure;   // nothing: only trying its mapping tells
  std::optional<bool> confirmed;      // way 0: the drive reports the offset that it holds
  std::vector<std::string> missing;   // for the best way, a sentence each
  std::vector<std::string> warnings;  // what to look after, a sentence each

  // A way fits as far as can be read, and nothing is missing for it.
  [[nodiscard]] bool good() const {
    return best != Way::none && best_is_sure.value_or(true) && missing.empty();
  }
};

struct DriveCheckOptions {
  std::uint8_t node = 32;         // of the compensation, which the drive is to watch
  std::optional<double> feed_mm;  // of a linear axis for one turn of its drive
};

[[nodiscard]] DriveCheck check_drive(const ForeignDrive& drive, const DriveCheckOptions& options);

[[nodiscard]] std::string describe(const DriveCheck& check);
[[nodiscard]] nlohmann::json to_json(const DriveCheck& check);

}  // namespace volcomp::host
