#include "plant/record.hpp"

namespace interlock::plant {

std::uint64_t Record::find(std::uint64_t tick) const {
  std::uint64_t low = begin();
  std::uint64_t high = end();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if ((*this)[middle].tick < tick) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace interlock::plant
