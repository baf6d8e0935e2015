// What each object of the node is for: the lines PURPOSE of its dictionary.

#include <array>

#include "host_sim/host/bus/explain/object_text.hpp"

namespace volcomp::host {
namespace {

struct Purpose {
  unsigned first;
  unsigned last;
  const char* text;
};

constexpr std::array kPurposes{
#define PURPOSE(first, last, text) Purpose{first, last, text},
#include "firmware/canopen/communication.def"
#define PURPOSE(first, last, text) Purpose{first, last, text},
#include "firmware/node/objects.def"
};

}  // namespace

const char* purpose(unsigned index) {
  for (const Purpose& p : kPurposes) {
    if (index >= p.first && index <= p.last) return p.text;
  }
  return nullptr;
}

}  // namespace volcomp::host
