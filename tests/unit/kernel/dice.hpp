/// Seeded chance, the same on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace interlock::kernel_test {

class Dice {
 public:
  explicit Dice(uint32_t seed) : engine_(seed) {}

  uint32_t word() { return static_cast<uint32_t>(engine_()); }
  /// 0 to `count` - 1.
  uint32_t below(uint32_t count) { return word() % count; }
  int32_t between(int32_t low, int32_t high) {
    return low + static_cast<int32_t>(below(static_cast<uint32_t>(high - low) + 1));
  }
  bool one_in(uint32_t chances) { return below(chances) == 0; }

 private:
  std::mt19937 engine_;
};

}  // namespace interlock::kernel_test
