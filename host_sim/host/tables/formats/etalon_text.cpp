#include "host_sim/host/tables/formats/etalon_text.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

class EtalonReader {
 public:
  EtalonReader(std::istream& stream, const std::string& name, ForeignErrors& errors)
      : lines_(stream, name), errors_(errors) {}

  void read() {
    std::string line;
    while (lines_.any(line)) {
      const std::string_view content = trimmed(without_comment(line));
      if (content.empty()) continue;
      if (in_grid_) {
        read_grid_line(content);
      } else if (content.front() == '[') {
        begin_block(content);
      } else {
        read_assignment(content);
      }
    }
    if (in_grid_) lines_.fail(fmt::format("the file ends inside Gridpoints of [{}]", block_));
    if (block_.empty()) throw UserError(lines_.name() + ": there is no block [name] in the file");
    end_block();
  }

 private:
  void begin_block(std::string_view content) {
    end_block();
    block_.clear();
    if (content.back() == ']') block_ = std::string(content.substr(1, content.size() - 2));
    if (!read_error_name(block_, name_))
      lines_.fail(fmt::format("unknown block {} (known: errors as [EXX], locations as [C0Y])",
                              quoted(content)));
    const auto found = errors_.axis.find(name_.axis);
    if (!name_.location && found != errors_.axis.end() && !found->second.at(name_.channel).empty())
      lines_.fail(fmt::format("{} is there twice", block_));
    filled_ = false;
  }

  void end_block() const {
    if (!block_.empty() && !filled_) lines_.fail(fmt::format("[{}] has no value", block_));
  }

  void read_assignment(std::string_view content) {
    const std::size_t equals = content.find('=');
    if (block_.empty() || equals == std::string_view::npos)
      lines_.fail(
          fmt::format("expected [name], VALUE = or Gridpoints = {{, not {}", quoted(content)));
    const std::string_view key = trimmed(content.substr(0, equals));
    const std::string_view value = trimmed(content.substr(equals + 1));
    if (filled_) lines_.fail(fmt::format("[{}] has two values", block_));
    if (name_.location && key == "VALUE") {
      add_location(errors_, block_, lines_.number(value), lines_);
      filled_ = true;
    } else if (!name_.location && key == "Gridpoints" && value == "{") {
      in_grid_ = true;
    } else {
      lines_.fail(fmt::format("{} is not what [{}] needs: {}", quoted(content), block_,
                              name_.location ? "VALUE = number" : "Gridpoints = {"));
    }
  }

  void read_grid_line(std::string_view content) {
    if (content == "}") {
      if (!filled_) lines_.fail(fmt::format("Gridpoints of [{}] are empty", block_));
      in_grid_ = false;
      return;
    }
    const std::vector<std::string_view> words = words_of(content);
    if (words.size() != 2)
      lines_.fail(fmt::format("expected: position error, not {}", quoted(content)));
    add_point(errors_, name_, lines_.number(words[0]), lines_.number(words[1]), lines_);
    filled_ = true;
  }

  CsvLines lines_;
  ForeignErrors& errors_;
  std::string block_;
  ErrorName name_;
  bool in_grid_ = false;
  bool filled_ = false;
};

}  // namespace

void read_etalon(std::istream& stream, const std::string& name, ForeignErrors& errors) {
  EtalonReader(stream, name, errors).read();
}

}  // namespace volcomp::host
