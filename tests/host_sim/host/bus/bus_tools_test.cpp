// Tools for a node on the bus: objects read and written, tables sent and fetched, the state of the
// node in words, the load of the bus.

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/bytes.hpp"
#include "comp/tables/image.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "host_sim/host/bus/bus_load.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "tests/hal/memory_blocks.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"

namespace volcomp::host {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using testing::HasSubstr;

template <class Exception, class Call>
std::string text_of(Call&& call) {
  try {
    call();
  } catch (const Exception& e) {
    return e.what();
  }
  return "(nothing was thrown)";
}

// An image ends with the number that names it.
std::uint32_t crc_of(const std::vector<std::uint8_t>& image) {
  return static_cast<std::uint32_t>(load_le(&image[image.size() - 4], 4));
}

// --- objects

TEST(NodeClient, ReadsBackWhatItWrote) {
  ServiceBench bench;
  bench.write({0x2200, 1}, {0x41, 0x01, 0, 0});
  EXPECT_EQ(number(bench.client.read({0x2200, 1}, 4, "ramp")), 0x141U);
  EXPECT_EQ(value_of<char>(bench.client.read({0x1008, 0}, 24, "name")), "volcomp compensation");
}

// CiA 301, table 22: 0602 0000h, object does not exist.
TEST(NodeClient, RefusalCarriesTheAbortCode) {
  ServiceBench bench;
  try {
    bench.write({0x5000, 0}, {1});
    FAIL() << "nothing was thrown";
  } catch (const NodeRefused& refused) {
    EXPECT_EQ(static_cast<std::uint32_t>(refused.code), 0x0602'0000U);
    EXPECT_THAT(refused.what(), HasSubstr("5000h:00"));
  }
  EXPECT_EQ(number(bench.client.read({0x1001, 0}, 1, "errors")), 0);
}

TEST(NodeClient, SaysWhenNobodyAnswers) {
  ServiceBench bench(nullptr, false);
  EXPECT_EQ(text_of<UserError>([&] {
              bench.write({0x2200, 1}, {1, 0, 0, 0});
            }),
            "node 32 does not answer");
  EXPECT_FALSE(bench.client.await_heartbeat(1'000'000));
}

// A node that has just answered has the right number.
TEST(NodeClient, SaysWhenANodeStopsAnswering) {
  ServiceBench bench;
  EXPECT_EQ(number(bench.client.read({0x1001, 0}, 1, "errors")), 0);
  bench.send({0x000, 2, {2, ServiceBench::kNodeId}});  // STOPPED: no SDO
  EXPECT_THAT(text_of<UserError>([&] {
                bench.write({0x2200, 1}, {1, 0, 0, 0});
              }),
              HasSubstr("the node has stopped answering"));
}

// Reported by this side, not by the node.
TEST(NodeClient, AnAnswerThatIsTooLongIsNoRefusal) {
  ServiceBench bench;
  EXPECT_THAT(text_of<UserError>([&] {
                static_cast<void>(number(bench.client.read({0x1008, 0}, 4, "name")));
              }),
              HasSubstr("1008h:00"));
  EXPECT_EQ(value_of<char>(bench.client.read({0x1008, 0}, 24, "name")), "volcomp compensation");
}

TEST(NodeClient, HearsTheHeartbeat) {
  ServiceBench bench;
  bench.pass_us(10'000);
  EXPECT_EQ(bench.client.await_heartbeat(1'000'000), canopen::NmtState::pre_operational);
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  EXPECT_EQ(bench.client.await_heartbeat(1'000'000), canopen::NmtState::operational);
}

// --- tables

TEST(TableTransfer, WhatIsSentBecomesActiveAndComesBack) {
  ServiceBench bench;
  const std::vector<std::uint8_t>& image = known_machine().image;
  std::vector<std::size_t> progress;
  send_image(bench.client, image, [&](std::size_t bytes) { progress.push_back(bytes); });
  arm_tables(bench.client);
  EXPECT_EQ(active_tables(bench.client).crc, 0U);
  activate_tables(bench.client);
  EXPECT_EQ(active_tables(bench.client).crc, crc_of(image));
  EXPECT_EQ(fetch_image(bench.client), image);
  EXPECT_GT(progress.size(), 2U);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
}

TEST(TableTransfer, NodeNamesTheAxisOfADamagedImage) {
  ServiceBench bench;
  std::vector<std::uint8_t> image = known_machine().image;
  image[image_value_offset(known_machine().tables, 1, 0, 3, 0)] ^= 1U;
  send_image(bench.client, image);
  const std::string text = text_of<NodeRefused>([&] { arm_tables(bench.client); });
  EXPECT_THAT(text, HasSubstr("axis Y"));
  EXPECT_THAT(text, HasSubstr(sentence(Reason::crc_mismatch)));
  EXPECT_THAT(text, HasSubstr("08000000h"));
}

TEST(TableTransfer, NothingToFetchIsARefusal) {
  ServiceBench bench;
  EXPECT_THROW(static_cast<void>(fetch_image(bench.client)), NodeRefused);
}

TEST(TableTransfer, NodeWithoutStoreSaysSo) {
  ServiceBench bench;
  EXPECT_THAT(text_of<NodeRefused>([&] { store_all(bench.client); }),
              HasSubstr("the node has no store"));
}

TEST(TableTransfer, AStoreThatFailsIsReportedWithItsReason) {
  const auto blocks = std::make_unique<volcomp::test::MemoryBlocks<16384, 2>>();
  node::RecordStorage<volcomp::test::MemoryBlocks<16384, 2>> storage(*blocks);
  ServiceBench bench(&storage);
  blocks->refuse_erases(true);
  EXPECT_THAT(text_of<NodeRefused>([&] { store_all(bench.client); }),
              HasSubstr("failure while erasing"));
  EXPECT_THAT(describe(diagnose(bench.client)), HasSubstr("failure while erasing"));
  blocks->refuse_erases(false);
  store_all(bench.client);
}

TEST(TableTransfer, FilesNoNodeCanTakeAreRefusedUnsent) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image.vct";
  write_whole_file(path, "");
  EXPECT_THAT(text_of<UserError>([&] { static_cast<void>(read_image_file(path)); }),
              HasSubstr("empty"));
  write_whole_file(path, std::string(1'000'000, 'x'));
  EXPECT_THAT(text_of<UserError>([&] { static_cast<void>(read_image_file(path)); }),
              HasSubstr("larger"));
  EXPECT_THAT(text_of<UserError>([&] { static_cast<void>(read_image_file(folder.path())); }),
              HasSubstr("cannot be opened"));
}

// --- diagnosis

TEST(Diagnosis, HealthyNode) {
  ServiceBench bench;
  bench.write({0x2010, 1}, {1});
  send_image(bench.client, known_machine().image);
  activate_tables(bench.client);
  const nlohmann::json d = diagnose(bench.client);
  EXPECT_EQ(d.at("network_state"), "PRE-OPERATIONAL, waits to be started");
  EXPECT_EQ(d.at("table_state"), "active");
  EXPECT_EQ(d.at("active_crc"), fmt::format("{:08X}", crc_of(known_machine().image)));
  EXPECT_TRUE(d.at("errors").empty());
  ASSERT_EQ(d.at("axes").size(), 1U);
  EXPECT_EQ(d.at("axes").at(0).at("letter"), "X");
  EXPECT_EQ(d.at("axes").at(0).at("drive"), 1);
  EXPECT_THAT(describe(d), HasSubstr("PRE-OPERATIONAL"));
  EXPECT_THAT(describe(d), HasSubstr("power was switched on"));
}

TEST(Diagnosis, RefusedTablesAreInTheHistoryWithTheirReason) {
  ServiceBench bench;
  send_image(bench.client, std::vector<std::uint8_t>(100, 7));
  EXPECT_THROW(arm_tables(bench.client), NodeRefused);
  const nlohmann::json d = diagnose(bench.client);
  ASSERT_EQ(d.at("errors").size(), 1U);
  EXPECT_EQ(d.at("errors").at(0).at("field").get<std::uint32_t>() & 0xFFFFU, 0xFF10U);
  EXPECT_EQ(d.at("refusal"), sentence(Reason::bad_magic));
  EXPECT_THAT(describe(d), HasSubstr(sentence(Reason::bad_magic)));
}

// Patterns of the statusword: CiA 402-2, table 33.
TEST(Diagnosis, DriveStatesInWords) {
  EXPECT_THAT(describe_drive(0x0250), HasSubstr("switching on disabled"));
  EXPECT_THAT(describe_drive(0x0231), HasSubstr("ready to switch on"));
  EXPECT_THAT(describe_drive(0x0233), HasSubstr("not enabled"));
  EXPECT_THAT(describe_drive(0x1737), testing::StartsWith("enabled"));
  EXPECT_THAT(describe_drive(0x0217), HasSubstr("quick stop"));
  EXPECT_THAT(describe_drive(0x0218), testing::StartsWith("fault"));
}

TEST(Diagnosis, EveryStatusBitHasItsOwnWords) {
  std::set<std::string> words;
  for (int bit = 0; bit < kStatusBits; ++bit)
    words.insert(describe_status(static_cast<std::uint16_t>(1U << static_cast<unsigned>(bit))));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(kStatusBits));
  EXPECT_EQ(describe_status(kValid | kRamping), "corrected; a change is being ramped in");
}

TEST(Diagnosis, ErrorsNameWhomTheyConcern) {
  EXPECT_THAT(describe_error(0x0003'8130), testing::StartsWith("node 3: "));
  EXPECT_THAT(describe_error(0x0002'FF02), testing::StartsWith("axis 2: "));
  EXPECT_THAT(describe_error(0x0059'FF10), testing::StartsWith("axis Y: "));
  EXPECT_THAT(describe_error(0x0002'6010), testing::StartsWith("by the watchdog: "));
  EXPECT_THAT(describe_error(0x0000'1000), HasSubstr("another device"));
}

TEST(Diagnosis, ErrorsOfTheStoreSayWhatWentWrong) {
  EXPECT_THAT(describe_error(0x0008'5530), HasSubstr("failure while erasing"));
  EXPECT_THAT(describe_error(0x0002'6310), HasSubstr("the one before is used"));
}

TEST(Diagnosis, EveryErrorCodeHasItsOwnSentence) {
  const std::vector<ErrorCode> codes{ErrorCode::none,
                                     ErrorCode::memory_damaged,
                                     ErrorCode::program_damaged,
                                     ErrorCode::store_failed,
                                     ErrorCode::unexpected_reset,
                                     ErrorCode::background_overdue,
                                     ErrorCode::parameters_lost,
                                     ErrorCode::can_overrun,
                                     ErrorCode::can_passive,
                                     ErrorCode::heartbeat,
                                     ErrorCode::bus_off_recovered,
                                     ErrorCode::sync_length,
                                     ErrorCode::rpdo_length,
                                     ErrorCode::rpdo_timeout,
                                     ErrorCode::axis_not_referenced,
                                     ErrorCode::axis_implausible,
                                     ErrorCode::axis_clamped,
                                     ErrorCode::axis_out_of_range,
                                     ErrorCode::no_authority,
                                     ErrorCode::table_refused,
                                     ErrorCode::table_damaged,
                                     ErrorCode::time_doubted,
                                     ErrorCode::foreign_sync,
                                     ErrorCode::offset_not_confirmed,
                                     ErrorCode::touch_rejected,
                                     ErrorCode::point_lost};
  std::set<std::string> sentences;
  for (const ErrorCode code : codes)
    sentences.insert(canopen::sentence(code));
  EXPECT_EQ(sentences.size(), codes.size());
}

// --- bus load

// A frame of n bytes has 47 + 8 n bits and at most ⌊(34 + 8 n − 1) / 4⌋ stuff bits (ISO 11898-1).
TEST(BusLoad, ThreeAxesAt500Hz) {
  const ComputedLoad load = compute_bus_load(3, 500.0);
  EXPECT_NEAR(load.nominal, (500 * (55 + 3 * (95 + 111 + 79 + 79)) + 50 * 55 + 10 * 111) / 1e6,
              1e-12);
  EXPECT_NEAR(load.worst, (500 * (65 + 3 * (115 + 135 + 95 + 95)) + 50 * 65 + 10 * 135) / 1e6,
              1e-12);
}

}  // namespace
}  // namespace volcomp::host
