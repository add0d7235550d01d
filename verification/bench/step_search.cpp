#include "step_search.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "flip.hpp"
#include "interlock/kernel.h"
#include "step_scenarios.hpp"
#include "world.hpp"

namespace {

std::uint64_t blocks_run;

}  // namespace

/// The compiler puts a call of this into each basic block of the kernel.
extern "C" void __sanitizer_cov_trace_pc() { blocks_run++; }

namespace interlock::bench {
namespace {

constexpr std::uint32_t kScenarioTicks = 200;
constexpr std::uint32_t kMostEdits = 4;
/// Of a case's ticks one is kept in so many, or all starts would be the same moment.
constexpr std::uint32_t kTicksApart = 1000;

constexpr std::size_t kStatusWord = 2;
constexpr std::size_t kCounterWord = 3;
constexpr std::size_t kHeartbeatWord = 9;
constexpr std::size_t kTimeWord = 10;
constexpr std::size_t kEchoWord = 11;
constexpr std::uint32_t kSwitchBit = 0x00080000;

/// What a step reads, without a copy of it.
struct StepView {
  const ilk_config_t& config;
  const ilk_state_t& state;
  const ilk_inputs_t& inputs;
  std::span<const ilk_request_t> requests;
};

std::uint64_t cost_of(const StepView& step) {
  ilk_state_t state = step.state;
  ilk_outputs_t out{};
  blocks_run = 0;
  ilk_step(&step.config, &state, &step.inputs, step.requests.data(),
           static_cast<std::uint32_t>(step.requests.size()), &out);
  return blocks_run;
}

/// Keeps the costliest step that it is shown.
class Costliest {
 public:
  explicit Costliest(std::string start) { best_.start = std::move(start); }

  void show(const StepView& step) {
    const std::uint64_t blocks = cost_of(step);
    if (blocks > best_.blocks) {
      best_.blocks = best_.start_blocks = blocks;
      best_.step = {step.config, step.state, step.inputs, {step.requests.begin(), step.requests.end()}};
    }
  }

  const Found& best() const { return best_; }

 private:
  Found best_;
};

Found costliest_of(std::string_view name) {
  const Scenario scenario = make_scenario(name, kScenarioTicks);
  Costliest costliest("scenario " + std::string(name));
  ilk_state_t state{};
  ilk_outputs_t out{};
  ilk_init(&scenario.config, &state);
  for (std::uint32_t tick = 0; tick < scenario.tape.size(); tick++) {
    const Tick& now = scenario.tape[tick];
    prepare(scenario, tick, state);
    costliest.show({scenario.config, state, now.inputs, now.requests});
    ilk_step(&scenario.config, &state, &now.inputs, now.requests.data(),
             static_cast<std::uint32_t>(now.requests.size()), &out);
  }
  return costliest.best();
}

void add_costliest_of(const campaign::Case& plan, std::vector<Found>& found) {
  const auto world = std::make_unique<campaign::World>(plan);
  for (std::uint32_t first = 0; first < plan.ticks; first += kTicksApart) {
    Costliest costliest("campaign seed " + std::to_string(plan.seed) + " case " +
                        std::to_string(plan.number) + " from tick " + std::to_string(first));
    for (std::uint32_t tick = 0; tick < kTicksApart; tick++) {
      const ilk_state_t before = world->state();
      static_cast<void>(world->step());
      costliest.show({world->config(), before, world->inputs(), world->requests()});
    }
    found.push_back(costliest.best());
  }
}

void seal_frame(std::uint32_t (&frame)[ILK_FRAME_WORDS]) {
  std::uint32_t sum = 0;
  for (std::size_t word = 0; word + 1 < ILK_FRAME_WORDS; word++) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = 0xFFFFFFFFu - sum;
}

/// Runs the step, and makes the next one of the same inputs and requests, with fresh frames.
void advance(StepCase& step) {
  ilk_outputs_t out{};
  ilk_step(&step.config, &step.state, &step.inputs, step.requests.data(),
           static_cast<std::uint32_t>(step.requests.size()), &out);
  for (auto& frame : step.inputs.frame) {
    frame[kHeartbeatWord]++;
    frame[kTimeWord] += step.config.common.period_us;
    frame[kEchoWord]++;
    seal_frame(frame);
  }
}

}  // namespace

std::uint64_t cost_of(const StepCase& step) {
  return cost_of(StepView{step.config, step.state, step.inputs, step.requests});
}

std::vector<Found> StepSearch::gather(std::uint64_t cases, std::size_t most) {
  std::vector<Found> found;
  for (std::uint64_t number = 0; number < cases; number++) {
    add_costliest_of(campaign::make_case(seed_, number), found);
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &Found::blocks);
  found.resize(std::min(found.size(), most));
  for (const std::string_view name : kScenarios) {
    found.push_back(costliest_of(name));
  }
  return found;
}

ilk_request_t StepSearch::draft(const StepCase& step) {
  ilk_request_t request{};
  request.kind = random_.below(ILK_REQUEST_COUNT + 1);
  request.axis = random_.below(ILK_SLOTS + (random_.chance(0.05) ? 1 : 0));
  request.holder = random_.chance(0.9) ? step.state.system.holder : random_.below(4);
  request.consent = step.state.system.consent ^ (random_.chance(0.02) ? 1u : 0u);
  const std::size_t slot = std::min<std::size_t>(request.axis, ILK_SLOTS - 1);
  const ilk_axis_config_t& axis = step.config.axis[slot];
  const auto span = static_cast<std::uint32_t>(axis.max_counts) - static_cast<std::uint32_t>(axis.min_counts);
  request.target_counts =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(axis.min_counts) + random_.below(span | 1));
  request.drive = random_.coin() ? axis.unhomed_max_drive : axis.max_drive;
  request.amplitude = axis.max_amplitude;
  request.lease_ticks = 1 + random_.below(step.config.common.lease_max_ticks | 1);
  return request;
}

void StepSearch::change_request(StepCase& step) {
  const auto count = static_cast<std::uint32_t>(step.requests.size());
  if (count < ILK_REQUESTS_PER_TICK && (count == 0 || random_.chance(0.4))) {
    const auto at = static_cast<std::ptrdiff_t>(random_.below(count + 1));
    step.requests.insert(step.requests.begin() + at, draft(step));
  } else if (random_.chance(0.15)) {
    step.requests.erase(step.requests.begin() + static_cast<std::ptrdiff_t>(random_.below(count)));
  } else if (random_.chance(0.3)) {
    std::swap(step.requests[random_.below(count)], step.requests[random_.below(count)]);
  } else {
    step.requests[random_.below(count)] = draft(step);
  }
}

void StepSearch::change_frame(StepCase& step) {
  const std::uint32_t slot = random_.below(ILK_SLOTS);
  auto& frame = step.inputs.frame[slot];
  switch (random_.below(6)) {
    case 0:
      frame[kStatusWord] ^= kSwitchBit;
      break;
    case 1:
      frame[kCounterWord] += random_.below(7) - 3;
      break;
    case 2:
      frame[kCounterWord] += random_.below(401) - 200;
      break;
    case 3:
      step.inputs.frames_received ^= 1u << slot;
      break;
    case 4:
      // As a card that answers in time.
      frame[kHeartbeatWord] = step.state.axis[slot].heartbeat + 1;
      frame[kEchoWord] = step.state.system.tick - ILK_LATENCY_TICKS;
      step.inputs.frames_received |= 1u << slot;
      break;
    default:
      frame[random_.below(ILK_FRAME_WORDS)] ^= 1u << random_.below(32);
      break;
  }
  if (random_.chance(0.9)) {
    seal_frame(frame);
  }
}

void StepSearch::change_contacts(StepCase& step) {
  ilk_inputs_t& inputs = step.inputs;
  std::uint32_t* const words[] = {&inputs.pedal_no_closed,   &inputs.pedal_nc_closed,
                                  &inputs.estop_loop_closed, &inputs.deadlines_missed,
                                  &inputs.transaction_done,  &inputs.link_generation};
  *words[random_.below(std::size(words))] ^= random_.chance(0.9) ? 1u : 2u;
}

void StepSearch::damage(StepCase& step) {
  if (random_.coin()) {
    campaign::flip(step.state, random_.below(campaign::kStateBits));
  } else {
    campaign::flip(step.config, random_.below(campaign::kConfigBits));
  }
}

void StepSearch::change(StepCase& step) {
  const std::uint32_t choice = random_.below(100);
  if (choice < 45) {
    change_request(step);
  } else if (choice < 80) {
    change_frame(step);
  } else if (choice < 90) {
    change_contacts(step);
  } else if (choice < 98) {
    advance(step);
  } else {
    damage(step);
  }
}

/// Numbers and seals the requests as an app does, mostly.
void StepSearch::finish(StepCase& step) {
  if (random_.chance(0.05)) {
    return;
  }
  const bool is_anew = step.inputs.link_generation != step.state.system.link_generation;
  std::uint32_t sequence = is_anew ? 0 : step.state.system.last_sequence;
  for (ilk_request_t& request : step.requests) {
    request.sequence = ++sequence;
    request.crc = ilk_request_crc(&request);
  }
}

Found StepSearch::climb(const Found& start, std::uint64_t tries) {
  Found best = start;
  for (std::uint64_t n = 0; n < tries; n++) {
    StepCase tried = best.step;
    for (std::uint32_t edits = 1 + random_.below(kMostEdits); edits > 0; edits--) {
      change(tried);
    }
    finish(tried);
    const std::uint64_t blocks = cost_of(tried);
    if (blocks >= best.blocks) {
      best.step = std::move(tried);
      best.blocks = blocks;
    }
  }
  return best;
}

}  // namespace interlock::bench
