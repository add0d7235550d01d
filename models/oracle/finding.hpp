/**
 * @file
 * What the oracle reports: a tick, a property of the kernel's specification, an axis and a reason.
 */
#ifndef INTERLOCK_ORACLE_FINDING_HPP
#define INTERLOCK_ORACLE_FINDING_HPP

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace interlock::oracle {

/** The properties of the specification, by their numbers there. */
enum class Property : std::uint8_t {
  kP1 = 1,
  kP2,
  kP3,
  kP4,
  kP5,
  kP6,
  kP7,
  kP8,
  kP9,
  kP10,
  kP11,
  kP12,
  kP13,
  kP14,
  kP16 = 16,
};

/** Slot of a finding that concerns no single axis. */
inline constexpr std::int8_t kNoAxis = -1;

struct Finding {
  std::uint32_t tick = 0;
  Property property = Property::kP1;
  std::int8_t axis = kNoAxis;
  std::string_view reason; /**< a literal: it outlives the oracle */
};

/** The findings of one tick. Those beyond its capacity are counted only. */
class Findings {
 public:
  void clear() noexcept { count_ = 0; }

  void report(std::uint32_t tick, Property property, std::int8_t axis, std::string_view reason) noexcept {
    if (count_ < kept_.size()) {
      kept_[count_] = {tick, property, axis, reason};
    }
    count_++;
  }

  std::span<const Finding> kept() const noexcept {
    return std::span(kept_).first(count_ < kept_.size() ? count_ : kept_.size());
  }

  std::size_t count() const noexcept { return count_; }

 private:
  std::array<Finding, 32> kept_{};
  std::size_t count_ = 0;
};

}  // namespace interlock::oracle

#endif
