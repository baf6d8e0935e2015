// The object that CONTRIBUTING.md adds, by the two lines shown there.

#include <gtest/gtest.h>

#include "firmware/canopen/communication_objects.hpp"

namespace volcomp {
namespace {

namespace lines = canopen::object_lines;
using canopen::AbortCode;
using canopen::ObjectId;

struct AddedObjects {
  canopen::CommunicationObjects communication{};
#define NODE OBJECT_MEMBER
#include "added_object.def"
};

constexpr std::array kOwn{
#define NODE(index, sub, count, type, member, use, value, range, name)                   \
  lines::row<lines::type>(index, sub, count, offsetof(AddedObjects, member), lines::use, \
                          lines::range, name),
#include "added_object.def"
};
constexpr auto kNamed = canopen::with_communication(kOwn);

namespace object {
#define NODE(index, sub, count, type, member, use, value, range, name) \
  constexpr lines::Handle<lines::type> member{index, sub, count, name};
#include "added_object.def"
}  // namespace object

struct Core {
  bool running = false;
  [[nodiscard]] bool operational() const { return running; }
};

AbortCode before_write(const Core& core_, ObjectId object) {
#include "added_handler.inc"
  return AbortCode::none;
}

class AddedObject : public testing::Test {
 protected:
  [[nodiscard]] AbortCode write(std::uint16_t seconds) {
    const auto found = dictionary.find(object::warm_up_s.id());
    const std::array<std::uint8_t, 2> bytes{static_cast<std::uint8_t>(seconds),
                                            static_cast<std::uint8_t>(seconds >> 8U)};
    const AbortCode why = dictionary.check(*found.entry, bytes);
    if (why == AbortCode::none) canopen::ObjectDictionary::assign(*found.entry, found.value, bytes);
    return why;
  }

  AddedObjects objects;
  canopen::ObjectDictionary dictionary{canopen::DictionaryOf<kNamed>::value, &objects};
};

TEST_F(AddedObject, HoldsItsDefault) { EXPECT_EQ(objects.warm_up_s, 30); }

TEST_F(AddedObject, TakesWhatIsInItsRange) {
  EXPECT_EQ(write(600), AbortCode::none);
  EXPECT_EQ(objects.warm_up_s, 600);
  EXPECT_EQ(write(601), AbortCode::value_too_high);
  EXPECT_EQ(objects.warm_up_s, 600);
}

TEST_F(AddedObject, IsFoundUnderItsIndexAndSaved) {
  const auto found = dictionary.find(ObjectId{0x2207, 1});
  ASSERT_NE(found.entry, nullptr);
  EXPECT_TRUE(found.entry->has(canopen::kStored));
  EXPECT_EQ(dictionary.find(ObjectId{0x2207, 2}).why, AbortCode::no_subindex);
}

TEST_F(AddedObject, AsksItsHandler) {
  EXPECT_EQ(before_write(Core{false}, object::warm_up_s.id()), AbortCode::none);
  EXPECT_EQ(before_write(Core{true}, object::warm_up_s.id()), AbortCode::device_state);
  EXPECT_EQ(before_write(Core{true}, ObjectId{0x2206, 1}), AbortCode::none);
}

}  // namespace
}  // namespace volcomp
