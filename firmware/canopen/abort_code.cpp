#include "firmware/canopen/abort_code.hpp"

namespace volcomp::canopen {

const char* sentence(AbortCode code) {
  switch (code) {
    case AbortCode::none:
      return "The transfer succeeded.";
#define ABORT_CODE(number, name, sentence) \
  case AbortCode::name:                    \
    return sentence;
#include "firmware/canopen/codes.def"
  }
  return "The device gave an abort code of its own.";
}

}  // namespace volcomp::canopen
