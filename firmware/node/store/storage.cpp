#include "firmware/node/store/storage.hpp"

namespace volcomp::node {

const char* sentence(StoreResult result) {
  switch (result) {
#define STORE_RESULT(number, name, sentence) \
  case StoreResult::name:                    \
    return sentence;
#include "firmware/node/states.def"
  }
  return "Unknown result.";
}

}  // namespace volcomp::node
