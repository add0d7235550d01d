/// Recorded ticks for the step's benches.
///
/// Inputs do not depend on outputs here: the counters run as if every axis moved at one count a tick, so
/// a tape of ticks can be made first and played with nothing but the step inside the clock.
#ifndef INTERLOCK_BENCH_STEP_SCENARIOS_HPP
#define INTERLOCK_BENCH_STEP_SCENARIOS_HPP

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interlock/types.h"

namespace interlock::bench {

inline constexpr uint32_t kWarmUpTicks = 100;

struct Tick {
  ilk_inputs_t inputs{};
  std::vector<ilk_request_t> requests;
};

struct Scenario {
  ilk_config_t config;
  std::vector<Tick> tape;
  /// The state is damaged every so many ticks, and the last tick before the next damage is measured;
  /// 0 leaves the state alone and measures every tick.
  uint32_t damage_period = 0;
};

/// `moving` and `idle` are the usual ones; the others were written to cost much.
inline constexpr std::array<std::string_view, 5> kScenarios = {"moving", "idle", "moving_high_frequency",
                                                               "rebuilding", "revalidating"};

/// The scenario of that name, with so many ticks after those of the warm-up that are to be measured.
Scenario make_scenario(std::string_view name, uint32_t measured);

/// Whether that tick is one to be measured.
bool is_measured(const Scenario& scenario, uint32_t tick);

/// Damages the state where the scenario says so, before that tick.
void prepare(const Scenario& scenario, uint32_t tick, ilk_state_t& state);

}  // namespace interlock::bench

#endif
