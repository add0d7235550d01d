#include "bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <fstream>

namespace interlock::plant::test {
namespace {

ilk_axis_config_t sample_axis(ilk_card_t card, ilk_limit_side_t side, std::int32_t lower,
                              std::int32_t upper) {
  ilk_axis_config_t axis{};
  axis.card = card;
  axis.motor_direction = 1;
  axis.direction_correction = 1;
  axis.limit_side = side;
  axis.min_counts = lower;
  axis.max_counts = upper;
  axis.coast_counts = 12;
  axis.max_drive = kMaxDrive;
  return axis;
}

std::uint32_t packed_signal(const ilk_axis_config_t& axis, bool direction_bit, std::uint32_t drive) {
  if (axis.card == ILK_CARD_NON_PWM) {
    return (direction_bit ? 0x40000000u : 0xC0000000u) + drive;
  }
  return (direction_bit ? 0u : 0x80000000u) + drive;
}

}  // namespace

ilk_config_t sample_robot() {
  ilk_config_t robot{};
  robot.common.version = ILK_CONFIG_VERSION;
  robot.common.size_bytes = sizeof robot;
  robot.common.period_us = 1000;
  robot.common.pedal_channels = 2;
  robot.axis[kPwm] = sample_axis(ILK_CARD_PWM, ILK_LIMIT_UPPER, -1222, 8);
  robot.axis[kNonPwm] = sample_axis(ILK_CARD_NON_PWM, ILK_LIMIT_NONE, -8073, 8073);
  robot.axis[kNonPwm].motor_direction = 0;
  robot.axis[kLower] = sample_axis(ILK_CARD_NON_PWM, ILK_LIMIT_LOWER, 0, 1650);
  robot.axis[kAnalog] = sample_axis(ILK_CARD_ANALOG, ILK_LIMIT_NONE, -5512, 5906);
  robot.axis[kAnalog].direction_correction = 0;
  robot.axis[kHighFrequency] = sample_axis(ILK_CARD_HIGH_FREQUENCY, ILK_LIMIT_NONE, -100000, 100000);
  robot.axis[kHighFrequency].max_drive = 397785;
  robot.axis[kHighFrequency].max_amplitude = 200;
  robot.axis[kSensor].card = ILK_CARD_SENSOR;
  return robot;
}

Parameters exact_parameters() {
  Parameters parameters = default_parameters(sample_robot());
  parameters.pedal = {.lag = Microseconds{0}, .bounce = Microseconds{0}};
  parameters.estop.bounce = Microseconds{0};
  for (AxisParameters& axis : parameters.axis) {
    axis.noise_counts = 0;
    axis.backlash_counts = 0;
    axis.switch_bounce = Microseconds{0};
  }
  return parameters;
}

void write_robot(const ilk_config_t& robot, const std::filesystem::path& path) {
  ilk_config_t sealed = robot;
  boost::crc_32_type crc;
  crc.process_bytes(&sealed, offsetof(ilk_config_t, crc));
  sealed.crc = crc.checksum();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&sealed), sizeof sealed);
}

Bench::Bench(const Parameters& parameters, std::uint64_t seed, const ilk_config_t& robot)
    : plant(robot, parameters, seed), robot_(robot) {
  exchange.magic = ILK_SIM_MAGIC;
  exchange.power = 1;
}

void Bench::drive(std::size_t slot, Sense sense, std::uint32_t drive) {
  const ilk_axis_config_t& axis = robot_.axis[slot];
  const bool direction_bit = (sense == Sense::kDecreasing) == (axis.motor_direction == 1);
  auto& frame = exchange.frame[slot];
  stop(slot);
  if (axis.card == ILK_CARD_HIGH_FREQUENCY) {
    frame[2] = (direction_bit ? 0u : 1u) << 24 | axis.max_amplitude;
    frame[4] = (direction_bit ? 1u : 0u) << 24 | axis.max_amplitude;
    frame[3] = frame[5] = drive;
  } else {
    frame[axis.card == ILK_CARD_ANALOG ? 6 : 3] = packed_signal(axis, direction_bit, drive);
  }
  frame[14] = 1;
}

void Bench::stop(std::size_t slot) {
  std::fill(std::begin(exchange.frame[slot]), std::end(exchange.frame[slot]), 0u);
}

void Bench::seal(std::size_t slot) {
  auto& frame = exchange.frame[slot];
  frame[0] = 0xFEFEFE01u;
  frame[13] = kernel_tick;
  std::uint32_t sum = 0;
  for (std::size_t word = 0; word + 1 < ILK_FRAME_WORDS; ++word) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = 0xFFFFFFFFu - sum;
}

void Bench::run(std::uint32_t ticks) {
  for (std::uint32_t n = 0; n < ticks; ++n) {
    exchange.tick = kernel_tick;
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      seal(slot);
    }
    reply = plant.tick(exchange);
    ++kernel_tick;
  }
}

void Bench::schedule(const command::Command& command, std::optional<std::uint64_t> at) {
  const auto tick = plant.schedule(command, at);
  ASSERT_TRUE(tick.has_value()) << tick.error();
}

}  // namespace interlock::plant::test
