/// Looks for the step of the kernel that costs most: from the costliest steps of many, by chance and uphill.
///
/// Cost is the number of basic blocks that a step runs, counted by a kernel that was compiled to count them:
/// it does not depend on the machine's load, so equal seeds find equal steps. Every state that is tried was
/// reached by steps from the start; inputs and requests are any, and before a step a bit of state or
/// configuration may have flipped.
#ifndef INTERLOCK_BENCH_STEP_SEARCH_HPP
#define INTERLOCK_BENCH_STEP_SEARCH_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "plant/random.hpp"
#include "step_case.hpp"

namespace interlock::bench {

/// A costly step, and how it was found.
struct Found {
  StepCase step;
  std::uint64_t blocks = 0;
  std::uint64_t start_blocks = 0; /**< of the step from which the search began */
  std::string start;              /**< where that came from */
};

class StepSearch {
 public:
  explicit StepSearch(std::uint64_t seed) : seed_(seed), random_(seed, 0) {}

  /// The costliest steps of the hand-written scenarios and of so many cases of the fault campaign.
  std::vector<Found> gather(std::uint64_t cases, std::size_t most);

  /// Changes the step again and again and keeps what costs no less.
  Found climb(const Found& start, std::uint64_t tries);

 private:
  void change(StepCase& step);
  void change_request(StepCase& step);
  void change_frame(StepCase& step);
  void change_contacts(StepCase& step);
  void damage(StepCase& step);
  void finish(StepCase& step);
  ilk_request_t draft(const StepCase& step);

  std::uint64_t seed_;
  plant::Random random_;
};

/// Basic blocks of that step.
std::uint64_t cost_of(const StepCase& step);

}  // namespace interlock::bench

#endif
