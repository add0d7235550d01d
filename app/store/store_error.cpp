#include "store/store_error.hpp"

namespace interlock {

std::string StoreError::message() const {
  std::string text = problem;
  if (!expected.empty()) {
    text += "; expected " + expected;
  }
  if (!next_step.empty()) {
    text += "; " + next_step;
  }
  return text;
}

}  // namespace interlock
