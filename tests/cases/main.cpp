// volcomp_cases FILE...: runs reference cases through the library. Exit 1 if any failed, 2 if a
// file is unusable.

#include <exception>

#include <fmt/format.h>

#include "tests/cases/handlers.hpp"

int main(int argc, char** argv) {
  try {
    if (argc < 2) {
      fmt::print(stderr, "usage: volcomp_cases FILE...   (format volcomp-cases-1)\n");
      return 2;
    }
    volcomp::cases::Handlers handlers;
    volcomp::cases::add_id_geometry(handlers);
    volcomp::cases::add_id_solution(handlers);
    volcomp::cases::add_measured_gears(handlers);
    volcomp::cases::add_measured_intervals(handlers);
    volcomp::cases::add_measured_refusals(handlers);
    volcomp::cases::add_measurement(handlers);
    volcomp::cases::add_measuring_instruments(handlers);
    volcomp::cases::add_offset_limits(handlers);
    volcomp::cases::add_s0_calibration(handlers);
    volcomp::cases::add_s0_gear(handlers);
    volcomp::cases::add_s0_geometry(handlers);
    volcomp::cases::add_s1_geometry(handlers);
    volcomp::cases::add_s1_tables(handlers);
    volcomp::cases::add_s1_compensation(handlers);
    volcomp::cases::add_s1_bad_input(handlers);
    volcomp::cases::add_s2_face(handlers);
    volcomp::cases::add_s2_frame(handlers);
    volcomp::cases::add_s2_maps(handlers);
    volcomp::cases::add_s3_evaluation(handlers);
    volcomp::cases::add_s3_flank(handlers);
    volcomp::cases::add_s3_geometry(handlers);
    volcomp::cases::add_s3_learning(handlers);
    volcomp::cases::add_s3_table_file(handlers);
    volcomp::cases::Tally tally;
    for (int i = 1; i < argc; ++i)
      volcomp::cases::run_file(argv[i], handlers, tally);

    std::string last_id;
    int failed = 0;
    for (const auto& failure : tally.failed) {
      fmt::print("FAIL {}  {}\n", failure.id, failure.text);
      failed += failure.id != last_id ? 1 : 0;
      last_id = failure.id;
    }
    fmt::print("{} passed, {} failed\n", tally.passed, failed);
    return failed == 0 ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "volcomp_cases: {}\n", e.what());
    return 2;
  }
}
