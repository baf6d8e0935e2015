#pragma once
// Where results go: files, or standard output for "-". Text for people then goes to standard error,
// so that a pipe holds only the result.

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/whole_file.hpp"

namespace volcomp::cli {

using host::shown_output;

// A result for programs. The name of a file need not be UTF-8 as JSON is.
[[nodiscard]] std::string json_text(const nlohmann::json& result);

// The results of a command, each a file that appears whole or standard output; an empty name is no
// result. None is put in place before all are written.
class Results {
 public:
  // Before anything is read or done. `folder` is that of add_folder() or add_files(), if there will
  // be one. Throws UserError for two results with one place, for a result that would replace an
  // input, and for one that has no place: its folder is not there or lets nothing in.
  explicit Results(const std::vector<std::string>& names, std::vector<std::string> inputs = {},
                   const std::string& folder = {});

  // The stream for people: standard output, or standard error when one of the results goes there.
  [[nodiscard]] std::FILE* text() const { return words_; }

  // All throw UserError naming the file or the folder.
  void add(const std::string& name, std::string_view content);
  // Made if need be.
  void add_folder(const std::string& folder) { files_.add_folder(folder); }
  // Adds files whose names were unknown before; refused as above.
  void add_files(const std::string& folder, const std::vector<host::NamedText>& files);
  void write();

 private:
  void announce(const std::string& name);
  void refuse_inputs(const std::string& name) const;
  void refuse_others(const std::string& name) const;

  std::vector<std::string> inputs_;
  std::vector<std::string> files_announced_;
  std::FILE* words_ = stdout;
  host::WholeFiles files_;
};

// For errors after write(): a sentence that the results are in their places all the same, or empty.
[[nodiscard]] std::string standing_results();

// Throws UserError when the output could not be written, to a full disk for instance.
void finish_standard_output();

}  // namespace volcomp::cli
