// What the owner of a real machine does, by a program that links volcomp_host and nothing of the
// simulation, the experiments or the command line: the whole library is linked, so that no function
// of it needs one of them.
//
//   volcomp_host_alone build-tables MACHINE IMAGE RUNS…
//   volcomp_host_alone setup LINK MACHINE
//   volcomp_host_alone download LINK IMAGE
//   volcomp_host_alone diagnose LINK
//   volcomp_host_alone verify BEFORE AFTER

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "comp/tables/image.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/verification.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace {

using volcomp::host::NodeClient;

constexpr std::uint8_t kNode = 32;

int build_tables(const std::vector<std::string>& words) {
  const auto machine = volcomp::host::read_machine_file(words.at(1));
  std::vector<volcomp::host::RunsFile> runs;
  for (std::size_t i = 3; i < words.size(); ++i)
    runs.push_back(volcomp::host::read_runs_file(words[i]));
  const auto built = volcomp::host::build_tables(machine, runs, {});
  const std::vector<std::uint8_t> image = volcomp::host::make_image(built->tables);
  std::ofstream out(words.at(2), std::ios::binary);
  out.write(reinterpret_cast<const char*>(image.data()),
            static_cast<std::streamsize>(image.size()));
  if (!out) throw volcomp::host::UserError(words.at(2) + ": cannot be written");
  std::printf("%zu bytes\n", image.size());
  return 0;
}

NodeClient connect(const std::string& link) {
  return {kNode, volcomp::host::LinkPump(volcomp::host::open_frame_link(link))};
}

int setup(const std::vector<std::string>& words) {
  const auto machine = volcomp::host::read_machine_file(words.at(2));
  const volcomp::host::SetupPlan plan =
      volcomp::host::setup_plan(machine, volcomp::host::setup_bus(machine, {}, {}));
  NodeClient client = connect(words.at(1));
  const auto result = volcomp::host::set_up(client, machine, plan, {false, {}});
  std::fputs(volcomp::host::describe(result).c_str(), stdout);
  return result.ok() ? 0 : 1;
}

int download(const std::vector<std::string>& words) {
  const std::vector<std::uint8_t> image = volcomp::host::read_image_file(words.at(2));
  NodeClient client = connect(words.at(1));
  volcomp::host::send_image(client, image, [](std::size_t) {});
  volcomp::host::arm_tables(client);
  volcomp::host::activate_tables(client);
  const std::uint32_t active = volcomp::host::active_tables(client).crc;
  std::printf("active: CRC-32 %08X\n", static_cast<unsigned>(active));
  return active == volcomp::image_crc({image.data(), image.size()}) ? 0 : 1;
}

int diagnose(const std::vector<std::string>& words) {
  NodeClient client = connect(words.at(1));
  std::fputs(volcomp::host::describe(volcomp::host::diagnose(client)).c_str(), stdout);
  return 0;
}

int verify(const std::vector<std::string>& words) {
  const volcomp::host::VerificationInput input{volcomp::host::read_diagonals_file(words.at(1)),
                                               volcomp::host::read_diagonals_file(words.at(2)),
                                               {},
                                               {},
                                               {},
                                               {},
                                               {}};
  const auto result = volcomp::host::verify(input);
  std::fputs(volcomp::host::verification_text(input, result).c_str(), stdout);
  return result.ok ? 0 : 1;
}

int run(const std::vector<std::string>& words) {
  if (words.at(0) == "build-tables") return build_tables(words);
  if (words.at(0) == "setup") return setup(words);
  if (words.at(0) == "download") return download(words);
  if (words.at(0) == "diagnose") return diagnose(words);
  if (words.at(0) == "verify") return verify(words);
  throw volcomp::host::UserError("there is no command " + words.at(0));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "volcomp_host_alone: %s\n", problem.what());
    return 2;
  }
}
