#include "host_sim/report/report.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <nlohmann/json.hpp>

#include "host_sim/report/page.hpp"

namespace volcomp::sim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, std::string_view what, const std::error_code& reason) {
  std::string text = "Cannot " + std::string(what) + ' ' + file.string();
  if (reason) text += ": " + reason.message();
  throw std::runtime_error(text + '.');
}

// "</script" or "<!--" inside a text would end or derail the script element that
// holds the data. In JSON a "<" can only be part of a string, where \u003c means the same.
std::string escape_for_html(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size() + json.size() / 64);
  for (const char character : json) {
    if (character == '<') {
      escaped += "\\u003c";
    } else {
      escaped += character;
    }
  }
  return escaped;
}

std::string page_with(std::string_view json) {
  std::string page = report_page();
  const auto mark = page.find(report_data_mark);
  if (mark == std::string::npos)
    throw std::logic_error("the report page has no place for its data");
  return page.replace(mark, report_data_mark.size(), escape_for_html(json));
}

// A reader never sees half a file: the text goes to another name first.
void write_file(const fs::path& file, std::string_view text) {
  fs::path unfinished = file;
  unfinished += ".tmp";
  errno = 0;
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  std::error_code error(stream ? 0 : errno, std::generic_category());
  if (stream) fs::rename(unfinished, file, error);
  if (!stream || error) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    fail(file, "write", error);
  }
}

}  // namespace

void write_report(const nlohmann::json& document, const fs::path& directory) {
  // A name that is not UTF-8, say of a file, must not cost the whole report.
  const std::string json = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) fail(directory, "create the directory", error);
  write_file(directory / "report.json", json + '\n');
  write_file(directory / "report.html", page_with(json));
}

}  // namespace volcomp::sim
