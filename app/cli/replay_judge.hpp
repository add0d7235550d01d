/**
 * @file
 * `interlock replay --judge`: every monitor of the kernel's properties judges each replayed tick.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "interlock/recorded_block.h"
#include "monitors.h"

namespace interlock::cli {

/** A replayed tick that breaks a property. */
struct Violation {
  std::uint32_t tick; /**< the kernel's counter after it */
  ilk_judgement_t judgement;
};

/** Tick, slot, property, and what was found beside its bound, in the unit of the property. */
std::string describe(const Violation& violation);

/** Judges a recording up to the first violation. What a gap hides is not held against the kernel. */
class ReplayJudge {
 public:
  static constexpr std::uint32_t monitors = JUDGE_COUNT;

  /** Of a kernel with this configuration, which outlives the judge. */
  explicit ReplayJudge(const ilk_config_t& config);

  /** @param before the state before the tick */
  void add(const ilk_state_t& before, const ilk_recorded_tick_t& tick);

  [[nodiscard]] std::uint64_t ticks() const { return ticks_; } /**< judged */
  [[nodiscard]] const std::optional<Violation>& violation() const { return violation_; }

 private:
  const ilk_config_t& config_;
  bool config_valid_;
  ilk_ghost_t ghost_{};
  std::uint64_t ticks_ = 0;
  std::optional<Violation> violation_;
};

}  // namespace interlock::cli
