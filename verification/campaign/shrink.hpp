/**
 * @file
 * Runs cases, and makes a failing one small.
 */
#ifndef INTERLOCK_CAMPAIGN_SHRINK_HPP
#define INTERLOCK_CAMPAIGN_SHRINK_HPP

#include <functional>
#include <optional>

#include "plan.hpp"
#include "world.hpp"

namespace interlock::campaign {

struct Outcome {
  Totals totals;
  std::optional<Failure> failure; /**< with it the case ended */
};

Outcome run(const Case& plan);

/** The same failure, by its clause, in a case from which no fault can be taken away any more, unless
 * 300 runs of `run_case` were not enough for that. Nothing is added.
 */
Case shrink(const Case& plan, const Failure& failure,
            const std::function<Outcome(const Case&)>& run_case = run);

}  // namespace interlock::campaign

#endif
