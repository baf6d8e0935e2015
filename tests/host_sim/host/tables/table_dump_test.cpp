// The contents of an image, row by row; tests/system/cli_evaluate_test.sh reads the bytes of images
// by their layout.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/host/tables/table_dump.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::host {
namespace {

TableImage written_and_read(const MachineTables& tables) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "tables.vct";
  const std::vector<std::uint8_t> image = make_image(tables);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  return read_table_image(path);
}

TEST(TableDump, EveryKnotHasARowForEachDirection) {
  MachineTables tables = test::constant_tables(1500.0F);
  tables.axis[0].value[1][1] = {-250.0F, 0, 0, 0, 0, 0x1p-17F};
  tables.axis[1].q0 = -99'999'999;
  const TableImage image = written_and_read(tables);
  const std::string csv = tables_csv(image);
  EXPECT_THAT(csv, testing::HasSubstr("\nX,1,up,-100.000000,,1.5,0,0,0,0,0\n"
                                      "X,1,down,-100.000000,,1.5,0,0,0,0,0\n"
                                      "X,2,up,0.000000,,1.5,0,0,0,0,0\n"
                                      "X,2,down,0.000000,,-0.25,0,0,0,0,7.62939453\n"
                                      "Y,1,up,-99.999999,,"));
  EXPECT_EQ(tables_json(image).at("axes").at(0).at("down").at(1).at(0), -0.25);
}

TEST(TableDump, SaysWhereTheTablesComeFrom) {
  MachineTables tables = test::constant_tables(0.0F);
  tables.provenance = {77, 5, 1'700'000'000, 0, 21.5F, {'m', 'e', '\n'}};
  const TableImage image = written_and_read(tables);
  EXPECT_THAT(image_text(image),
              testing::AllOf(testing::HasSubstr("machine 77, chain w-X-Y-b-Z-t"),
                             testing::HasSubstr("built 2023-11-14 22:13:20 UTC, expires never"),
                             testing::HasSubstr("measured at 21.5 deg C, stamp \"me?\""),
                             testing::HasSubstr("axes that correct: XYZ")));
  EXPECT_FALSE(tables_json(image).at("provenance").contains("expires_utc"));
}

}  // namespace
}  // namespace volcomp::host
