#include "step_scenarios.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>

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
  axis.dead_zone_drive = 100;
  axis.max_drive = 131'071;
  axis.unhomed_max_drive = 13'107;
  axis.max_amplitude = (card == ILK_CARD_HIGH_FREQUENCY) ? 255 : 0;
  axis.unhomed_travel_counts = 200'000;
  axis.home_offset_counts = -990'000;
  axis.home_drive = 10'000;
  axis.home_slow_drive = 2'000;
  axis.home_travel_counts = 2'100'000;
  axis.home_timeout_ticks = 500'000;
  axis.home_clear_counts = 100;
  axis.home_tolerance_counts = 40;
  axis.switch_hysteresis_counts = 2;
  axis.full_speed_counts_per_s = 5'000;
  axis.home_speed_counts_per_s = 5'000;
  axis.home_slow_speed_counts_per_s = 500;
  axis.stall_ticks = 500;
  axis.stall_effort_ticks = 20;
  axis.stall_min_counts = 2;
  axis.reverse_counts = 20;
  axis.drift_counts = 20;
  axis.rest_ticks = 10;
  axis.max_delta_counts = 8;
  return axis;
}

ilk_config_t ten_axes(ilk_card_t card) {
  ilk_config_t config{};
  config.common = {.version = ILK_CONFIG_VERSION,
                   .size_bytes = sizeof(ilk_config_t),
                   .period_us = 1000,
                   .pedal_channels = 2,
                   .app_timeout_ticks = 100,
                   .lease_max_ticks = 100,
                   .pedal_debounce_ticks = 10,
                   .pedal_disagree_ticks = 50,
                   .power_up_ticks = 5,
                   .switch_debounce_ticks = 5,
                   .bad_frame_limit = 3,
                   .overrun_limit = 3};
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

/// Makes a tape: unlock, enable, press, then `work` fills each further tick. A kernel runs along, for the
/// number of the press that moves must carry.
class Recorder {
 public:
  Recorder(const ilk_config_t& config, bool to_motion) : config_(config), to_motion_(to_motion) {
    ilk_init(&config_, &state_);
  }

  std::vector<Tick> record(uint32_t ticks, const std::function<void(Recorder&)>& work) {
    std::vector<Tick> tape;
    for (uint32_t tick = 0; tick < ticks; ++tick) {
      current_ = Tick{};
      inputs(tick);
      prepare(tick);
      if (tick >= kWarmUpTicks / 2) {
        work(*this);
      }
      ilk_step(&config_, &state_, &current_.inputs, current_.requests.data(),
               static_cast<uint32_t>(current_.requests.size()), &out_);
      tape.push_back(current_);
    }
    const auto is_driven = [](uint32_t gate) { return gate == ILK_GATE_OPEN; };
    if (to_motion_ && !std::all_of(std::begin(out_.gate), std::end(out_.gate), is_driven)) {
      throw std::logic_error("a scenario in motion does not drive every axis");
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
      move.consent = state_.system.consent;
      move.crc = ilk_request_crc(&move);
    }
  }

 private:
  void inputs(uint32_t tick) {
    const bool pressed = to_motion_ && (tick >= kPress);
    const bool moving = to_motion_ && (tick > kWarmUpTicks / 2);
    ilk_inputs_t& in = current_.inputs;
    in.link_generation = 1;
    in.boot_nonce = 1;
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
    if (tick == kReset) {
      request(ILK_REQUEST_RESET, 0);
    }
    if (tick == kEnable) {
      for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
        request(ILK_REQUEST_ENABLE, slot);
      }
    }
  }

  static constexpr uint32_t kReset = 3;
  static constexpr uint32_t kEnable = 20; /**< at rest, power up */
  static constexpr uint32_t kPress = 25;

  const ilk_config_t config_;
  const bool to_motion_;
  ilk_state_t state_{};
  ilk_outputs_t out_{};
  Tick current_;
  uint32_t sequence_ = 0;
  uint32_t raw_ = 0;
};

/// Ticks after damage until a whole pass over the configuration has made it trusted again.
constexpr uint32_t kConfigurationPass = ILK_SLOTS;

}  // namespace

Scenario make_scenario(std::string_view name, uint32_t measured) {
  const uint32_t ticks = kWarmUpTicks + measured;
  const ilk_config_t pwm = ten_axes(ILK_CARD_PWM);
  const ilk_config_t waves = ten_axes(ILK_CARD_HIGH_FREQUENCY);
  if (name == "moving") {
    return {pwm, Recorder(pwm, true).record(ticks, [](Recorder& tick) {
              tick.move_all(0);
              tick.heartbeat();
            })};
  }
  if (name == "moving_high_frequency") {
    return {waves, Recorder(waves, true).record(ticks, [](Recorder& tick) {
              tick.move_all(255);
              tick.heartbeat();
              for (uint32_t slot = 0; slot < 5; ++slot) {
                tick.request(ILK_REQUEST_RESTORE, slot);
              }
            })};
  }
  if ((name == "rebuilding") || (name == "revalidating")) {
    const uint32_t period = (name == "rebuilding") ? 1 : kConfigurationPass;
    return {pwm,
            Recorder(pwm, true).record(kWarmUpTicks + period * measured,
                                       [](Recorder& tick) {
                                         tick.move_all(0);
                                         tick.heartbeat();
                                       }),
            period};
  }
  return {pwm, Recorder(pwm, false).record(ticks, [](Recorder&) {})};
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
