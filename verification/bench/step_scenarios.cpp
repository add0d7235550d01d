#include "step_scenarios.hpp"

#include <algorithm>
#include <functional>

#include "interlock/kernel.h"

namespace interlock::bench {
namespace {

constexpr uint32_t kDrive = 10'000;
constexpr uint32_t kLeaseTicks = 50;

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

/// Ticks after damage until a whole pass over the configuration has made it trusted again.
constexpr uint32_t kConfigurationPass = ILK_SLOTS;

}  // namespace

Scenario make_scenario(std::string_view name, uint32_t measured) {
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

bool is_measured(const Scenario& scenario, uint32_t tick) {
  const uint32_t period = std::max(scenario.damage_period, 1u);
  return (tick >= kWarmUpTicks) && ((tick - kWarmUpTicks) % period == period - 1);
}

void prepare(const Scenario& scenario, uint32_t tick, ilk_state_t& state) {
  const bool is_due = (scenario.damage_period != 0) && (tick >= kWarmUpTicks);
  if (is_due && ((tick - kWarmUpTicks) % scenario.damage_period == 0)) {
    state.axis[3].position_counts ^= 1;
  }
}

}  // namespace interlock::bench
