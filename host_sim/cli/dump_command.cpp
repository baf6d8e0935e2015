// volcomp dump

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/tables/table_dump.hpp"

namespace volcomp::cli {
namespace {

struct DumpArguments {
  std::string image;
  std::string csv_file;
  std::string json_file;
};

int dump(DumpArguments a) {
  if (a.csv_file.empty() && a.json_file.empty()) a.csv_file = host::kStandardStream;
  Results results({a.csv_file, a.json_file}, {a.image});
  const host::TableImage image = host::read_table_image(a.image);
  results.add(a.csv_file, host::tables_csv(image));
  results.add(a.json_file, json_text(host::tables_json(image)));
  results.write();
  if (results.text() == stdout) fmt::print("{}", host::image_text(image));
  return 0;
}

}  // namespace

void add_dump_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "dump", "Print what a table image holds: machine, origin and the error at every knot");
  auto a = std::make_shared<DumpArguments>();
  command->add_option("IMAGE", a->image, "Table image (.vct)")->required();
  command->add_option("--csv", a->csv_file,
                      "Write the tables to this file (default: standard output, unless --json)");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->callback([a, &code] { code = dump(*a); });
}

}  // namespace volcomp::cli
