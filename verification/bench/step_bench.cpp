/// Times `ilk_step` over recorded ticks and prints one JSON object.
///
/// Usage: step_bench [SCENARIO STEPS]: all scenarios timed, or one scenario for so many measured steps
/// (for an instruction counter, which watches `measured_step`).
///
/// Inputs do not depend on outputs here: the counters run as if every axis moved at one count a tick, so
/// a tape of ticks can be made first and played with nothing but the step inside the clock.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interlock/kernel.h"

namespace {

constexpr uint32_t kWarmUpTicks = 100;
constexpr uint32_t kMeasuredTicks = 20'000;
constexpr uint32_t kDrive = 10'000;
constexpr uint32_t kLeaseTicks = 50;

struct Tick {
  ilk_inputs_t inputs{};
  std::vector<ilk_request_t> requests;
};

ilk_axis_config_t axis_config(ilk_card_t card) {
  ilk_axis_config_t axis{};
  axis.card = card;
  axis.motor_direction = 1;
  axis.limit_side = ILK_LIMIT_LOWER;
  axis.min_counts = -1'000'000;
  axis.max_counts = 1'000'000;
  axis.coast_counts = 12;
  axis.backlash_counts = 1;
  axis.noise_counts = 1;
  axis.deadband_counts = 1;
  axis.max_drive = 131'071;
  axis.unhomed_max_drive = 13'107;
  axis.max_amplitude = (card == ILK_CARD_HIGH_FREQUENCY) ? 255 : 0;
  axis.unhomed_travel_counts = 200'000;
  axis.home_drive = 10'000;
  axis.home_travel_counts = 2'100'000;
  axis.home_backoff_counts = 1'000;
  axis.home_timeout_ticks = 500'000;
  axis.home_rest_ticks = 50;
  axis.home_speed_counts_per_s = 5'000;
  axis.stall_ticks = 500;
  axis.stall_min_counts = 2;
  axis.reverse_counts = 20;
  axis.drift_counts = 20;
  axis.settle_ticks = 50;
  axis.max_delta_counts = 8;
  return axis;
}

ilk_config_t ten_axes(ilk_card_t card) {
  ilk_config_t config{};
  config.version = ILK_CONFIG_VERSION;
  config.size_bytes = sizeof(ilk_config_t);
  config.period_us = 1000;
  config.pedal_channels = 2;
  config.app_timeout_ticks = 100;
  config.lease_max_ticks = 100;
  config.pedal_debounce_ticks = 10;
  config.pedal_disagree_ticks = 50;
  config.bad_frame_limit = 3;
  config.overrun_limit = 3;
  for (ilk_axis_config_t& axis : config.axis) {
    axis = axis_config(card);
  }
  config.crc = ilk_config_crc(&config);
  return config;
}

void write_frame(uint32_t (&frame)[ILK_FRAME_WORDS], uint32_t tick, uint32_t raw) {
  std::fill(std::begin(frame), std::end(frame), 0u);
  frame[0] = 0xfefefe01u;
  frame[2] = 0x00080000u;
  frame[3] = raw;
  frame[9] = tick + 1;
  frame[10] = tick * 1000;
  frame[11] = tick - 2;
  uint32_t sum = 0;
  for (uint32_t word = 0; word + 1 < ILK_FRAME_WORDS; ++word) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = 0xffffffffu - sum;
}

/// Makes a tape: unlock, enable, press, then `work` fills each further tick.
class Recorder {
 public:
  explicit Recorder(bool to_motion) : to_motion_(to_motion) {}

  std::vector<Tick> record(uint32_t ticks, const std::function<void(Recorder&)>& work) {
    std::vector<Tick> tape;
    for (uint32_t tick = 0; tick < ticks; ++tick) {
      current_ = Tick{};
      inputs(tick);
      prepare(tick);
      if (tick >= kWarmUpTicks / 2) {
        work(*this);
      }
      tape.push_back(current_);
    }
    return tape;
  }

  ilk_request_t& request(ilk_request_kind_t kind, uint32_t axis) {
    ilk_request_t record{};
    record.sequence = ++sequence_;
    record.kind = kind;
    record.axis = axis;
    record.crc = ilk_request_crc(&record);
    return current_.requests.emplace_back(record);
  }

  void heartbeat() { request(ILK_REQUEST_HEARTBEAT, 0); }

  void move_all(uint32_t amplitude) {
    for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
      ilk_request_t& move = request(ILK_REQUEST_MOVE, slot);
      move.target_counts = 150'000;
      move.drive = kDrive;
      move.amplitude = amplitude;
      move.lease_ticks = kLeaseTicks;
      move.crc = ilk_request_crc(&move);
    }
  }

 private:
  void inputs(uint32_t tick) {
    const bool pressed = to_motion_ && (tick >= 20);
    const bool moving = to_motion_ && (tick > kWarmUpTicks / 2);
    ilk_inputs_t& in = current_.inputs;
    in.link_generation = 1;
    in.transaction_done = 1;
    in.frames_received = (1u << ILK_SLOTS) - 1;
    in.pedal_no_closed = pressed ? 1 : 0;
    in.pedal_nc_closed = pressed ? 0 : 1;
    in.estop_loop_closed = 1;
    raw_ += moving ? 1 : 0;
    for (auto& frame : in.frame) {
      write_frame(frame, tick, raw_);
    }
  }

  void prepare(uint32_t tick) {
    if (!to_motion_ || (tick >= kWarmUpTicks / 2)) {
      return;
    }
    heartbeat();
    if (tick == 3) {
      request(ILK_REQUEST_RESET, 0);
    }
    if ((tick >= 5) && (tick < 5 + ILK_SLOTS)) {
      request(ILK_REQUEST_ENABLE, tick - 5);
    }
  }

  bool to_motion_;
  Tick current_;
  uint32_t sequence_ = 0;
  uint32_t raw_ = 0;
};

struct Scenario {
  ilk_config_t config;
  std::vector<Tick> tape;
  /// The state is damaged every so many ticks, and the last tick before the next damage is measured;
  /// 0 leaves the state alone and measures every tick.
  uint32_t damage_period = 0;
};

/// Ticks after damage until a whole pass over the configuration has made it trusted again.
constexpr uint32_t kConfigurationPass = ILK_SLOTS;

Scenario make_scenario(const std::string& name, uint32_t measured) {
  const uint32_t ticks = kWarmUpTicks + measured;
  if (name == "moving") {
    return {ten_axes(ILK_CARD_PWM), Recorder(true).record(ticks, [](Recorder& tick) {
              tick.move_all(0);
              tick.heartbeat();
            })};
  }
  if (name == "moving_high_frequency") {
    return {ten_axes(ILK_CARD_HIGH_FREQUENCY), Recorder(true).record(ticks, [](Recorder& tick) {
              tick.move_all(255);
              tick.heartbeat();
              for (uint32_t slot = 0; slot < 5; ++slot) {
                tick.request(ILK_REQUEST_RESTORE, slot);
              }
            })};
  }
  if ((name == "rebuilding") || (name == "revalidating")) {
    const uint32_t period = (name == "rebuilding") ? 1 : kConfigurationPass;
    return {ten_axes(ILK_CARD_PWM),
            Recorder(true).record(kWarmUpTicks + period * measured,
                                  [](Recorder& tick) {
                                    tick.move_all(0);
                                    tick.heartbeat();
                                  }),
            period};
  }
  return {ten_axes(ILK_CARD_PWM), Recorder(false).record(ticks, [](Recorder&) {})};
}

const std::vector<std::string> kScenarios = {"moving", "idle", "moving_high_frequency", "rebuilding",
                                             "revalidating"};

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
    const uint32_t period = std::max(scenario.damage_period, 1u);
    const uint32_t phase = (tick - kWarmUpTicks) % period;
    if ((tick >= kWarmUpTicks) && (scenario.damage_period != 0) && (phase == 0)) {
      state.axis[3].position_counts ^= 1;
    }
    if ((tick < kWarmUpTicks) || (phase != period - 1)) {
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

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3) {
    const auto steps = static_cast<uint32_t>(std::strtoul(argv[2], nullptr, 10));
    play(make_scenario(argv[1], steps));
    return 0;
  }
  nlohmann::json result;
  result["frame_words"] = ILK_FRAME_WORDS;
  result["reference_ns"] = reference_ns();
  for (const std::string& name : kScenarios) {
    result["scenarios"][name] = summary(play(make_scenario(name, kMeasuredTicks)));
  }
  std::cout << result.dump() << "\n";
  return 0;
}
