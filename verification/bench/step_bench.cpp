/// Times `ilk_step` over recorded ticks and prints one JSON object.
///
/// Usage: step_bench                  all scenarios timed
///        step_bench CASE             the same, and the step of that file (worst_path.cpp) as `searched`
///        step_bench SCENARIO STEPS   one scenario for so many measured steps, for an instruction counter,
///        step_bench CASE STEPS       which watches `measured_step`; or that step, so many times

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interlock/kernel.h"
#include "step_case.hpp"
#include "step_scenarios.hpp"

namespace {

using interlock::bench::kScenarios;
using interlock::bench::kWarmUpTicks;
using interlock::bench::make_scenario;
using interlock::bench::Scenario;
using interlock::bench::StepCase;
using interlock::bench::Tick;

/// As many passes of `revalidating`, of ten ticks each, are within the travel of a press.
constexpr uint32_t kMeasuredTicks = 10'000;

/// Not inlined: the instruction counter looks for this name.
[[gnu::noinline]] void measured_step(const ilk_config_t* config, ilk_state_t* state, const ilk_inputs_t* in,
                                     const ilk_request_t* requests, uint32_t count, ilk_outputs_t* out) {
  ilk_step(config, state, in, requests, count, out);
}

/// A chain of dependent multiplications: the same work on every machine, to compare machines by.
uint64_t reference_ns() {
  const auto start = std::chrono::steady_clock::now();
  volatile uint32_t sink = 1;
  uint32_t value = 1;
  for (uint32_t round = 0; round < 100'000; ++round) {
    value = value * 1664525u + 1013904223u;
  }
  sink = value;
  static_cast<void>(sink);
  const auto spent = std::chrono::steady_clock::now() - start;
  return static_cast<uint64_t>(std::chrono::nanoseconds(spent).count()) / 100;
}

/// What a reading of the clock adds to each time, in ns: the median of empty measurements.
int64_t clock_ns() {
  constexpr std::size_t readings = 10'001;
  std::vector<int64_t> times(readings);
  for (int64_t& spent : times) {
    const auto start = std::chrono::steady_clock::now();
    spent = std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
  }
  std::sort(times.begin(), times.end());
  return times[readings / 2];
}

/// Plays the tape; returns the time of each measured step in nanoseconds, the clock's own cost included.
std::vector<int64_t> play(const Scenario& scenario) {
  ilk_state_t state{};
  ilk_outputs_t out{};
  std::vector<int64_t> times;
  times.reserve(scenario.tape.size());
  if (ilk_init(&scenario.config, &state).error != ILK_CONFIG_ERROR_NONE) {
    std::cerr << "the bench's configuration is not valid\n";
    std::exit(1);
  }
  for (uint32_t tick = 0; tick < scenario.tape.size(); ++tick) {
    const Tick& now = scenario.tape[tick];
    const auto count = static_cast<uint32_t>(now.requests.size());
    interlock::bench::prepare(scenario, tick, state);
    if (!interlock::bench::is_measured(scenario, tick)) {
      ilk_step(&scenario.config, &state, &now.inputs, now.requests.data(), count, &out);
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    measured_step(&scenario.config, &state, &now.inputs, now.requests.data(), count, &out);
    times.push_back(std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count());
  }
  const bool drives = out.gate[ILK_SLOTS - 1] == ILK_GATE_OPEN;
  const bool expected = scenario.tape.back().inputs.pedal_no_closed == 1 && scenario.damage_period == 0;
  if (drives != expected) {
    std::cerr << "the scenario did not do what it is for: gate " << out.gate[ILK_SLOTS - 1] << "\n";
    std::exit(1);
  }
  return times;
}

/// Plays one step again and again; the same times.
std::vector<int64_t> play(const StepCase& step, uint32_t steps) {
  const auto count = static_cast<uint32_t>(step.requests.size());
  ilk_outputs_t out{};
  std::vector<int64_t> times;
  times.reserve(steps);
  for (uint32_t n = 0; n < steps; ++n) {
    ilk_state_t state = step.state;
    const auto start = std::chrono::steady_clock::now();
    measured_step(&step.config, &state, &step.inputs, step.requests.data(), count, &out);
    times.push_back(std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count());
  }
  return times;
}

nlohmann::json summary(std::vector<int64_t> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  return {{"steps", times.size()},
          {"median_ns", at(0.5)},
          {"p99_ns", at(0.99)},
          {"p999_ns", at(0.999)},
          {"max_ns", times.back()}};
}

StepCase case_of(const std::string& path) {
  const auto step = interlock::bench::read_step_case(path);
  if (!step) {
    std::cerr << step.error() << "\n";
    std::exit(2);
  }
  return *step;
}

/// For an instruction counter.
void play_only(const std::string& name, uint32_t steps) {
  if (std::find(kScenarios.begin(), kScenarios.end(), name) != kScenarios.end()) {
    play(make_scenario(name, steps));
  } else {
    play(case_of(name), steps);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3) {
    play_only(argv[1], static_cast<uint32_t>(std::strtoul(argv[2], nullptr, 10)));
    return 0;
  }
  nlohmann::json result;
  result["frame_words"] = ILK_FRAME_WORDS;
  result["reference_ns"] = reference_ns();
  result["clock_ns"] = clock_ns();
  for (const std::string_view name : kScenarios) {
    result["scenarios"][std::string(name)] = summary(play(make_scenario(name, kMeasuredTicks)));
  }
  if (argc == 2) {
    result["scenarios"]["searched"] = summary(play(case_of(argv[1]), kMeasuredTicks));
  }
  std::cout << result.dump() << "\n";
  return 0;
}
