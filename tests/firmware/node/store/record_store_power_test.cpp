// Power fails at every single operation of a save and of an erase, the device is left in every
// state such a failure can leave it in, and it fails again while that is being mended.

#include <string>

#include "tests/firmware/node/store/record_store_support.hpp"

namespace volcomp::node {
namespace {

using test::Torn;

const Record kNone{};
const Record kOlder = make_record(50, 90, 20);
const Record kOld = make_record(40, 100, 21);
const Record kNew = make_record(45, 80, 22);
const Record kNext = make_record(33, 110, 23);

struct Cut {
  std::size_t at;
  Torn torn;
};

std::string words(const Cut& cut) {
  return "power cut at operation " + std::to_string(cut.at) + ", state " +
         std::to_string(static_cast<int>(cut.torn));
}

template <class Flash>
class PowerFailure : public ::testing::Test {
 protected:
  // A device in use: the newest record, kOld, in either slot, kOlder beside it.
  static Flash in_use(std::size_t slot) {
    Flash flash;
    for (std::size_t i = 0; i <= slot; ++i)
      EXPECT_EQ(save(flash, kOlder), StoreResult::done);
    EXPECT_EQ(save(flash, kOld), StoreResult::done);
    return flash;
  }

  // Every way to cut `act` short on a device like `before`; visit(flash, cut) has power again.
  template <class Act, class Visit>
  static void cut_everywhere(const Flash& before, const Act& act, const Visit& visit) {
    Flash whole = before;
    ASSERT_EQ(act(whole), StoreResult::done);
    const std::size_t all = whole.operations() - before.operations();
    for (std::size_t at = 0; at < all; ++at) {
      for (const Torn torn : test::kEveryTorn) {
        const Cut cut{at, torn};
        SCOPED_TRACE(words(cut));
        Flash flash = before;
        flash.seed(static_cast<unsigned>(at));
        flash.cut_power_at(at, torn);
        EXPECT_NE(act(flash), StoreResult::done);
        flash.power_on();
        visit(flash, cut);
      }
    }
  }

  static auto saving(const Record& record) {
    return [&record](Flash& flash) { return save(flash, record); };
  }
  static StoreResult erasing(Flash& flash) { return erase_all(flash); }

  // `again` can always be stored and is found from then on.
  static void expect_works(Flash flash, const Record& again) {
    ASSERT_EQ(save(flash, again), StoreResult::done);
    expect_loads(flash, StoreResult::loaded, again);
  }

  static bool is_one_of(const Record& found, std::initializer_list<const Record*> allowed) {
    return std::any_of(allowed.begin(), allowed.end(),
                       [&found](const Record* record) { return found == *record; });
  }
};

// 256-bit units as in an STM32H7, 64-bit ones as in an STM32G4: there the header is torn as well.
using UnitSizes = ::testing::Types<test::MemoryBlocks<512, 2, 32>, test::MemoryBlocks<512, 2, 8>>;
TYPED_TEST_SUITE(PowerFailure, UnitSizes, );

TYPED_TEST(PowerFailure, ASaveLeavesTheOldRecordOrTheNewAndSaysWhich) {
  for (const std::size_t slot : {0U, 1U}) {
    const TypeParam before = this->in_use(slot);
    this->cut_everywhere(before, this->saving(kNew), [&](TypeParam& flash, const Cut& cut) {
      const Loaded found = load(flash);
      const bool is_new = found.record == kNew;
      EXPECT_TRUE(is_new || found.record == kOld);
      // Before the first unit is programmed nothing marks an older record.
      const bool begun = cut.at > 1 || (cut.at == 1 && cut.torn != Torn::untouched);
      const bool may_be_silent = is_new || !begun || cut.torn == Torn::unstable;
      EXPECT_TRUE(found.result == StoreResult::loaded_older ||
                  (found.result == StoreResult::loaded && may_be_silent));
      EXPECT_FALSE(found.result == StoreResult::loaded_older && is_new);
      this->expect_works(flash, kNext);
    });
  }
}

// The second failure hits the save that was to mend the first.
TYPED_TEST(PowerFailure, ASecondFailureLosesNothingEither) {
  const TypeParam before = this->in_use(0);
  this->cut_everywhere(before, this->saving(kNew), [&](TypeParam& once, const Cut& first) {
    const Record found = load(once).record;
    this->cut_everywhere(once, this->saving(kNext), [&](TypeParam& twice, const Cut&) {
      const Loaded again = load(twice);
      EXPECT_TRUE(this->is_one_of(again.record, {&found, &kNext}) ||
                  (first.torn == Torn::unstable && this->is_one_of(again.record, {&kOld, &kNew})));
      this->expect_works(twice, kNew);
    });
  });
}

TYPED_TEST(PowerFailure, TheFirstSaveLeavesNothingOrAllOfIt) {
  this->cut_everywhere(TypeParam{}, this->saving(kNew), [&](TypeParam& once, const Cut&) {
    const Loaded found = load(once);
    EXPECT_TRUE(this->is_one_of(found.record, {&kNone, &kNew}));
    EXPECT_EQ(found.result == StoreResult::loaded, found.record == kNew);
    this->expect_works(once, kNext);
  });
}

TYPED_TEST(PowerFailure, ASecondFailureOfTheFirstSaveIsNoDifferent) {
  this->cut_everywhere(TypeParam{}, this->saving(kNew), [&](TypeParam& once, const Cut& first) {
    const Record found = load(once).record;
    this->cut_everywhere(once, this->saving(kNext), [&](TypeParam& twice, const Cut&) {
      const Record again = load(twice).record;
      EXPECT_TRUE(this->is_one_of(again, {&found, &kNext}) ||
                  (first.torn == Torn::unstable && this->is_one_of(again, {&kNone, &kNew})));
      this->expect_works(twice, kNew);
    });
  });
}

TYPED_TEST(PowerFailure, AnEraseLeavesTheNewestRecordOrNothingNeverTheOneBefore) {
  for (const std::size_t slot : {0U, 1U}) {
    const TypeParam before = this->in_use(slot);
    this->cut_everywhere(before, this->erasing, [&](TypeParam& once, const Cut&) {
      const Record found = load(once).record;
      EXPECT_TRUE(this->is_one_of(found, {&kOld, &kNone}));
      this->expect_works(once, kNext);
      this->cut_everywhere(once, this->erasing, [&](TypeParam& twice, const Cut&) {
        EXPECT_TRUE(this->is_one_of(load(twice).record, {&found, &kNone}));
        this->expect_works(twice, kNext);
      });
      this->cut_everywhere(once, this->saving(kNext), [&](TypeParam& twice, const Cut&) {
        EXPECT_TRUE(this->is_one_of(load(twice).record, {&found, &kNone, &kNext}));
        this->expect_works(twice, kNew);
      });
      ASSERT_EQ(erase_all(once), StoreResult::done);
      EXPECT_EQ(load(once).result, StoreResult::nothing_stored);
    });
  }
}

// Bits that read differently every time: which record is found may change from start to start, but
// the one whose save was confirmed is never lost to saves that were not, however many.
TYPED_TEST(PowerFailure, UnstableBitsNeverCostAConfirmedRecord) {
  const TypeParam before = this->in_use(0);
  TypeParam whole = before;
  ASSERT_EQ(save(whole, kNew), StoreResult::done);
  const std::size_t all = whole.operations() - before.operations();
  const auto cut_save = [](TypeParam& flash, const Record& record, std::size_t at) {
    flash.cut_power_at(at, Torn::unstable);
    static_cast<void>(save(flash, record));
    flash.power_on();
  };
  const std::array<const Record*, 4> records{&kOld, &kNew, &kNext, &kOlder};
  for (std::size_t plan = 0; plan < all * all * all; ++plan) {
    const std::array<std::size_t, 3> at{plan % all, plan / all % all, plan / all / all};
    SCOPED_TRACE("cuts at " + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " +
                 std::to_string(at[2]));
    TypeParam flash = before;
    flash.seed(static_cast<unsigned>(plan));
    for (std::size_t step = 0; step < at.size(); ++step) {
      cut_save(flash, *records[step + 1], at[step]);
      const auto begun = records.begin() + static_cast<std::ptrdiff_t>(step) + 2;
      for (int starts = 0; starts < 2; ++starts) {
        const Record found = load(flash).record;
        EXPECT_TRUE(std::any_of(records.begin(), begun,
                                [&found](const Record* record) { return found == *record; }));
      }
    }
    this->expect_works(flash, kNew);
  }
}

}  // namespace
}  // namespace volcomp::node
