// The driver of the SJA1000 against the chip of its data sheet: what it writes and reads, what
// leaves in which order, and what happens when things go wrong.

#include "hal/sja1000/sja1000.hpp"

#include <map>
#include <stdexcept>

#include "tests/hal/sja1000_chip.hpp"
#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::CanBusState;
using hal::CanFrame;
using Ids = std::vector<unsigned>;

// Registers may only be touched while the interrupt of the chip is kept out.
int locks = 0;
struct Lock {
  Lock() { ++locks; }
  ~Lock() { --locks; }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
};

struct ChipRegisters {
  [[nodiscard]] std::uint8_t read(std::uint8_t address) const {
    if (locks != 1) throw std::logic_error("register read without the lock");
    return chip->read(address);
  }
  void write(std::uint8_t address, std::uint8_t value) const {
    if (locks != 1) throw std::logic_error("register written without the lock");
    chip->write(address, value);
  }
  Sja1000Chip* chip = nullptr;
};

using Can = hal::Sja1000<ChipRegisters, Lock>;
static_assert(hal::IsCanPort<Can>::value);

// 1 Mbit/s from 16 MHz: 8 time quanta of two clocks, sample point at 75 % (CiA 301, table 1).
constexpr hal::Sja1000Settings kSettings{0x00, 0x14, 0xDA, 0x47};

class Sja1000 : public testing::Test {
 protected:
  void SetUp() override {
    chip.hardware_reset();
    ASSERT_TRUE(can.start(ChipRegisters{&chip}, kSettings));
  }

  void serve() {
    while (chip.interrupt())
      can.on_interrupt();
  }
  void arrives(const CanFrame& f) {
    Sja1000Chip::BusFrame on_bus;
    on_bus.id = f.id;
    on_bus.length_code = f.size;
    on_bus.data = f.data;
    arrives(on_bus);
  }
  void arrives(const Sja1000Chip::BusFrame& f) { chip.receive(f); }

  // The bus is free for one frame; its identifier.
  unsigned bus_takes_one() {
    serve();
    EXPECT_TRUE(chip.begin_transmission());
    const unsigned id = chip.finish_transmission().id;
    serve();
    return id;
  }
  Ids bus_takes_all() {
    Ids ids;
    while (chip.wants_to_send())
      ids.push_back(bus_takes_one());
    return ids;
  }
  void drive_to_bus_off() {
    ASSERT_TRUE(can.send(frame(0x700)));
    for (int i = 0; i < 32 && !chip.in_reset(); ++i) {
      ASSERT_TRUE(chip.begin_transmission());
      chip.disturb_transmission();
      serve();
    }
    ASSERT_TRUE(chip.in_reset());
  }

  Sja1000Chip chip;
  Can can;
};

TEST_F(Sja1000, IsSetUpInPeliCanModeForEveryStandardDataFrame) {
  EXPECT_FALSE(chip.in_reset());
  EXPECT_EQ(chip.register_value(31), 0xC7);  // PeliCAN and the wiring
  EXPECT_EQ(chip.register_value(6), kSettings.bus_timing_0);
  EXPECT_EQ(chip.register_value(7), kSettings.bus_timing_1);
  EXPECT_EQ(chip.register_value(8), kSettings.output_control);
  EXPECT_EQ(can.state(), CanBusState::active);
  for (std::uint16_t id = 0; id <= hal::kMaxCanId; ++id) {
    arrives(frame(id, {static_cast<std::uint8_t>(id * 37)}));
    serve();
    CanFrame got;
    ASSERT_TRUE(can.receive(got)) << id;
    ASSERT_EQ(got.id, id);
  }
}

TEST_F(Sja1000, WithoutAChipItDoesNotStart) {
  struct Nothing {
    [[nodiscard]] std::uint8_t read(std::uint8_t /*address*/) const { return floating; }
    void write(std::uint8_t /*address*/, std::uint8_t /*value*/) const {}
    std::uint8_t floating = 0;
  };
  hal::Sja1000<Nothing, Lock> driver;
  EXPECT_FALSE(driver.start(Nothing{0x00}, kSettings));
  EXPECT_FALSE(driver.start(Nothing{0xFF}, kSettings));
  EXPECT_EQ(driver.state(), CanBusState::stopped);
  EXPECT_FALSE(driver.send(frame(1)));
  driver.supervise(Can::kBusOffPause_us);
  EXPECT_EQ(driver.state(), CanBusState::stopped);
}

// Its mode and clock divider answer as they should; there are no filters behind them.
TEST_F(Sja1000, WithoutFiltersItDoesNotStart) {
  struct NoFilters {
    [[nodiscard]] std::uint8_t read(std::uint8_t address) const {
      return address == 31 ? 0xC7 : 0x01;
    }
    void write(std::uint8_t /*address*/, std::uint8_t /*value*/) const {}
  };
  hal::Sja1000<NoFilters, Lock> driver;
  EXPECT_FALSE(driver.start(NoFilters{}, kSettings));
  EXPECT_EQ(driver.state(), CanBusState::stopped);
}

TEST_F(Sja1000, FrameStandsInTheTransmitBufferAsTheDataSheetSays) {
  ASSERT_TRUE(can.send(frame(0x5A3, {0x11, 0x22, 0x33})));
  const std::array<std::uint8_t, 6> expected{0x03, 0xB4, 0x60, 0x11, 0x22, 0x33};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(chip.transmit_buffer().at(i), expected.at(i)) << i;
}

TEST_F(Sja1000, EveryFrameArrivesAsItWasSent) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 500; ++i) {
    const CanFrame f = random_frame(random);
    ASSERT_TRUE(can.send(f));
    ASSERT_TRUE(chip.begin_transmission());
    arrives(chip.finish_transmission());
    serve();
    ASSERT_EQ(receive_all(can), std::vector<CanFrame>{f});
  }
  EXPECT_EQ(can.counters().sent, 500U);
  EXPECT_EQ(can.counters().received, 500U);
}

TEST_F(Sja1000, LengthCodeBeyondEightMeansEightBytes) {
  Sja1000Chip::BusFrame f;
  f.id = 0x123;
  f.length_code = 15;
  f.data = {1, 2, 3, 4, 5, 6, 7, 8};
  arrives(f);
  serve();
  EXPECT_EQ(receive_all(can), (std::vector<CanFrame>{frame(0x123, {1, 2, 3, 4, 5, 6, 7, 8})}));
}

TEST_F(Sja1000, RemoteAndExtendedFramesDoNotArrive) {
  Sja1000Chip::BusFrame remote;
  remote.id = 0x620;
  remote.remote = true;
  remote.length_code = 8;
  arrives(remote);
  for (std::uint32_t bit = 0; bit < 29; ++bit) {
    Sja1000Chip::BusFrame extended;
    extended.id = 1U << bit;
    extended.extended = true;
    arrives(extended);
    serve();
  }
  arrives(frame(0x621));
  serve();
  EXPECT_EQ(received_ids(can), (Ids{0x621}));
  EXPECT_EQ(can.counters().extended, 28U);  // one bit is where the other format has its RTR bit
}

TEST_F(Sja1000, OneInterruptEmptiesTheFifo) {
  for (std::uint16_t id = 1; id <= 21; ++id)
    arrives(frame(id));
  can.on_interrupt();
  EXPECT_FALSE(chip.interrupt());
  EXPECT_EQ(receive_all(can).size(), 21U);
  EXPECT_EQ(can.counters().fifo_overruns, 0U);
}

TEST_F(Sja1000, LateInterruptIsCountedAndCostsTheNewestFrames) {
  for (std::uint16_t id = 1; id <= 8; ++id)
    arrives(frame(id, {1, 2, 3, 4, 5, 6, 7, 8}));  // 11 bytes each, 64 there are
  serve();
  EXPECT_EQ(received_ids(can), (Ids{1, 2, 3, 4, 5}));
  EXPECT_EQ(can.counters().fifo_overruns, 1U);
  arrives(frame(9));
  serve();
  EXPECT_EQ(received_ids(can), (Ids{9}));
  for (std::uint16_t id = 1; id <= 8; ++id)
    arrives(frame(id, {1, 2, 3, 4, 5, 6, 7, 8}));
  serve();
  EXPECT_EQ(can.counters().fifo_overruns, 2U);
  EXPECT_EQ(can.take_losses(), 2U);
  EXPECT_EQ(can.take_losses(), 0U);
}

TEST_F(Sja1000, RarelyReadFramesAreCountedWhenLost) {
  for (std::uint16_t id = 0; id < Can::kReceiveCapacity + 3; ++id) {
    arrives(frame(id));
    serve();
  }
  EXPECT_EQ(can.counters().ring_overruns, 3U);
  EXPECT_EQ(can.take_losses(), 3U);
  const Ids ids = received_ids(can);
  ASSERT_EQ(ids.size(), Can::kReceiveCapacity);
  EXPECT_EQ(ids.back(), Can::kReceiveCapacity - 1);
}

TEST_F(Sja1000, FramesLeaveByIdentifier) {
  for (const int id : {0x5A0, 0x720, 0x301, 0x1A0, 0x303, 0x302})
    ASSERT_TRUE(can.send(frame(static_cast<std::uint16_t>(id))));
  EXPECT_EQ(bus_takes_all(), (Ids{0x1A0, 0x301, 0x302, 0x303, 0x5A0, 0x720}));
}

TEST_F(Sja1000, FramesWithOneIdentifierKeepTheirOrder) {
  for (std::uint8_t n = 0; n < 20; ++n)
    ASSERT_TRUE(can.send(frame(0x5A0, {n})));
  ASSERT_TRUE(can.send(frame(0x080)));
  EXPECT_EQ(bus_takes_one(), 0x080U);
  for (std::uint8_t n = 0; n < 20; ++n) {
    ASSERT_TRUE(chip.begin_transmission());
    ASSERT_EQ(chip.finish_transmission().data[0], n);
    serve();
  }
}

TEST_F(Sja1000, WaitingFrameGivesWayToAMoreUrgentOne) {
  ASSERT_TRUE(can.send(frame(0x5A0)));  // fills the only transmit buffer, the bus is busy
  ASSERT_TRUE(can.send(frame(0x301)));
  serve();
  EXPECT_EQ(can.counters().taken_back, 1U);
  EXPECT_EQ(bus_takes_all(), (Ids{0x301, 0x5A0}));
  EXPECT_EQ(can.counters().sent, 2U);
}

TEST_F(Sja1000, FrameOnTheWireIsNeitherStoppedNorDoubled) {
  ASSERT_TRUE(can.send(frame(0x5A0)));
  ASSERT_TRUE(chip.begin_transmission());
  ASSERT_TRUE(can.send(frame(0x301)));
  serve();
  EXPECT_EQ(chip.finish_transmission().id, 0x5A0U);
  serve();
  EXPECT_EQ(bus_takes_all(), (Ids{0x301}));
  EXPECT_EQ(can.counters().taken_back, 0U);
}

TEST_F(Sja1000, TheFrameOnTheWireIsAskedBackOnce) {
  ASSERT_TRUE(can.send(frame(0x300)));
  ASSERT_TRUE(chip.begin_transmission());
  ASSERT_TRUE(can.send(frame(0x200)));
  ASSERT_TRUE(can.send(frame(0x100)));
  EXPECT_EQ(chip.finish_transmission().id, 0x300U);
  serve();
  EXPECT_EQ(bus_takes_all(), (Ids{0x100, 0x200}));
  EXPECT_EQ(can.counters().sent, 3U);
}

// The interrupt of the first is served when the second is in the chip already.
TEST_F(Sja1000, ALateInterruptStopsNothing) {
  ASSERT_TRUE(can.send(frame(0x300)));
  ASSERT_TRUE(chip.begin_transmission());
  EXPECT_EQ(chip.finish_transmission().id, 0x300U);
  ASSERT_TRUE(can.send(frame(0x200)));
  serve();
  EXPECT_EQ(bus_takes_all(), (Ids{0x200}));
  EXPECT_EQ(can.counters().taken_back, 0U);
}

// One place is reserved for the frame that was in the chip, and one only.
TEST(SendQueue, HoldsOneMoreThatComesBack) {
  hal::SendQueue<2> queue;
  EXPECT_TRUE(queue.push(frame(2)));
  EXPECT_TRUE(queue.push(frame(3)));
  EXPECT_FALSE(queue.push(frame(1)));
  queue.put_back(frame(1));
  queue.put_back(frame(0));
  EXPECT_EQ(queue.size(), 3U);
  for (const unsigned id : {1U, 2U, 3U})
    EXPECT_EQ(queue.pop().id, id);
}

TEST_F(Sja1000, FullQueueTakesNothing) {
  std::size_t taken = 0;
  while (taken < 100 && can.send(frame(0x5A0)))
    ++taken;
  EXPECT_EQ(taken, Can::kSendCapacity + 1);  // and one in the chip
  EXPECT_EQ(can.counters().refused, 1U);
  bus_takes_one();
  EXPECT_TRUE(can.send(frame(0x301)));
  EXPECT_EQ(bus_takes_one(), 0x301U);  // the frame taken back for it finds its place
  EXPECT_EQ(bus_takes_all().size(), Can::kSendCapacity);
}

// Whatever the bus does: nothing is lost, doubled or reordered within its identifier, and no frame
// starts while the driver holds a more urgent one.
TEST_F(Sja1000, RandomTrafficLeavesCompleteAndByUrgency) {
  Random random;
  SCOPED_TRACE(random.trace());
  std::multimap<unsigned, std::uint8_t> waiting;
  std::uint8_t number = 0;
  const auto offer = [&] {
    const auto id = static_cast<std::uint16_t>(random.integer(0, 7) << 8);
    if (can.send(frame(id, {number}))) waiting.emplace(id, number++);
  };
  for (int i = 0; i < 20'000; ++i) {
    if (random.chance(0.5)) offer();
    if (random.chance(0.7)) serve();
    if (random.chance(0.4) || !chip.begin_transmission()) continue;
    const unsigned most_urgent = waiting.begin()->first;
    if (random.chance(0.3)) offer();  // too late to stop the one that leaves
    const Sja1000Chip::BusFrame sent = chip.finish_transmission();
    ASSERT_EQ(sent.id, most_urgent);
    const auto oldest = waiting.lower_bound(sent.id);
    ASSERT_NE(oldest, waiting.end());
    ASSERT_EQ(oldest->second, sent.data[0]);
    waiting.erase(oldest);
  }
  EXPECT_GT(can.counters().sent, 5000U);
  EXPECT_GT(can.counters().taken_back, 500U);
  EXPECT_GT(can.counters().refused, 100U);
}

TEST_F(Sja1000, ErrorsShowInTheState) {
  const auto receive_errors = [this](int count) {
    for (int i = 0; i < count; ++i)
      chip.receive_error();
    serve();
  };
  receive_errors(95);
  EXPECT_EQ(can.state(), CanBusState::active);
  receive_errors(1);
  EXPECT_EQ(can.state(), CanBusState::warning);
  receive_errors(32);
  EXPECT_EQ(can.state(), CanBusState::passive);
  for (int i = 0; i < 33; ++i)
    chip.receive_good();
  serve();
  EXPECT_EQ(can.state(), CanBusState::active);
  EXPECT_EQ(can.counters().bus_offs, 0U);
}

TEST_F(Sja1000, BusOffEndsAfterThePauseAndTheQuietBus) {
  can.supervise(1'000'000);
  drive_to_bus_off();
  EXPECT_EQ(can.state(), CanBusState::off);
  EXPECT_EQ(can.counters().bus_offs, 1U);
  EXPECT_FALSE(can.send(frame(0x301)));

  can.supervise(1'000'000 + Can::kBusOffPause_us - 1);
  EXPECT_TRUE(chip.in_reset());
  can.supervise(1'000'000 + Can::kBusOffPause_us);
  EXPECT_FALSE(chip.in_reset());
  EXPECT_EQ(can.state(), CanBusState::off);  // not yet allowed to take part
  chip.quiet_bus(127);
  serve();
  EXPECT_FALSE(can.send(frame(0x301)));
  chip.quiet_bus(1);
  serve();
  EXPECT_EQ(can.state(), CanBusState::active);

  EXPECT_EQ(bus_takes_all(), Ids{});  // what waited is outdated and gone
  ASSERT_TRUE(can.send(frame(0x302)));
  EXPECT_EQ(bus_takes_all(), (Ids{0x302}));
  arrives(frame(0x080));
  serve();
  EXPECT_EQ(received_ids(can), (Ids{0x080}));
  EXPECT_EQ(can.counters().bus_offs, 1U);
}

TEST_F(Sja1000, EachBusOffCounts) {
  std::uint64_t now_us = 0;
  for (std::uint32_t n = 1; n <= 3; ++n) {
    now_us += 1'000'000;
    can.supervise(now_us);
    drive_to_bus_off();
    EXPECT_EQ(can.counters().bus_offs, n);
    can.supervise(now_us + Can::kBusOffPause_us);
    chip.quiet_bus(128);
    serve();
    ASSERT_EQ(can.state(), CanBusState::active);
  }
}

TEST_F(Sja1000, ChipThatLostItsSettingsGetsThemAgain) {
  can.supervise(0);
  chip.hardware_reset();
  can.supervise(1000);
  EXPECT_EQ(can.state(), CanBusState::off);
  can.supervise(Can::kBusOffPause_us);
  EXPECT_EQ(can.state(), CanBusState::active);
  EXPECT_EQ(chip.register_value(7), kSettings.bus_timing_1);
  arrives(frame(0x7FF));
  serve();
  EXPECT_EQ(received_ids(can), (Ids{0x7FF}));
}

}  // namespace
}  // namespace volcomp::test
