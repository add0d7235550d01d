#include "shrink.hpp"

#include <algorithm>
#include <memory>

namespace interlock::campaign {
namespace {

constexpr std::uint32_t kMostRuns = 300; /**< about half a minute */

/** The plan without `count` faults from `first` on. */
Case without(const Case& plan, std::size_t first, std::size_t count) {
  Case less = plan;
  const auto begin = less.faults.begin() + static_cast<std::ptrdiff_t>(first);
  less.faults.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return less;
}

void end_at(Case& plan, std::uint32_t tick) {
  plan.ticks = tick + 1;
  std::erase_if(plan.faults, [tick](const Fault& fault) { return fault.tick > tick; });
}

}  // namespace

Outcome run(const Case& plan) {
  // The plant's record alone takes megabytes.
  const auto world = std::make_unique<World>(plan);
  Outcome outcome;
  while (!outcome.failure && world->totals().ticks < plan.ticks) {
    outcome.failure = world->step();
  }
  outcome.totals = world->totals();
  return outcome;
}

Case shrink(const Case& plan, const Failure& failure, const std::function<Outcome(const Case&)>& run_case) {
  Case best = plan;
  end_at(best, failure.tick);
  std::uint32_t runs_left = kMostRuns;
  bool removed = false;
  for (std::size_t size = std::max<std::size_t>(best.faults.size() / 2, 1); size > 0;
       size = size == 1 && removed ? 1 : size / 2) {
    removed = false;
    for (std::size_t first = 0; first < best.faults.size() && runs_left > 0; runs_left--) {
      Case less = without(best, first, std::min(size, best.faults.size() - first));
      const Outcome outcome = run_case(less);
      if (outcome.failure && outcome.failure->clause == failure.clause) {
        end_at(less, outcome.failure->tick);
        best = std::move(less);
        removed = true;
      } else {
        first += size;
      }
    }
  }
  return best;
}

}  // namespace interlock::campaign
