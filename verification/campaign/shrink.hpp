/**
 * @file
 * Runs cases, and makes a failing one small.
 */
#ifndef INTERLOCK_CAMPAIGN_SHRINK_HPP
#define INTERLOCK_CAMPAIGN_SHRINK_HPP

#include <optional>

#include "plan.hpp"
#include "world.hpp"

namespace interlock::campaign {

struct Outcome {
  Totals totals;
  std::optional<Failure> failure; /**< with it the case ended */
};

Outcome run(const Case& plan);

/** The same failure, for the same reason, with as few faults and ticks as removing them shows; nothing is
 * added.
 */
Case shrink(const Case& plan, const Failure& failure);

}  // namespace interlock::campaign

#endif
