/**
 * @file
 * Every shipped robot homes from everywhere, with noise, bounce and glitches of its switches: within one
 * count of the true place of the switch, or not at all and with a fault.
 */
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "interlock/kernel.h"
#include "plant/exchange.hpp"
#include "plant/parameters_file.hpp"
#include "plant/plant.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

namespace interlock::plant::test {
namespace {

const std::filesystem::path kFolder = INTERLOCK_MODELS;
constexpr std::uint64_t kStarts = 200;
constexpr std::uint32_t kStartWord = 0xfefefe01u;
constexpr std::uint32_t kSwitchOpenBit = 0x00080000u;

/** Where an axis stands before it homes. */
enum class Start { kNearStop, kFarStop, kOnTheSwitch, kJustBeyondIt, kMidRange, kCount };

/** From 0 to 1. */
double part(std::mt19937_64& dice) { return static_cast<double>(dice() % 1001) / 1000; }

bool glitches(std::mt19937_64& dice) { return dice() % 500 == 0; }

/** Distance inward from the edge of the switch, from one stop to the other; counts. */
double inward_counts(const ilk_axis_config_t& axis, const AxisParameters& plant, Start start,
                     std::mt19937_64& dice) {
  const bool lower = axis.limit_side == ILK_LIMIT_LOWER;
  const double home = axis.home_offset_counts;
  const double to_near_stop =
      (lower ? home - axis.min_counts : axis.max_counts - home) + plant.end_margin_counts;
  const double to_far_stop =
      (lower ? axis.max_counts - home : home - axis.min_counts) + plant.end_margin_counts;
  switch (start) {
    case Start::kNearStop:
      return -to_near_stop;
    case Start::kFarStop:
      return to_far_stop;
    case Start::kOnTheSwitch:
      return -to_near_stop * part(dice);
    case Start::kJustBeyondIt:
      return (plant.switch_hysteresis_counts + 2) * part(dice);
    default:
      return to_far_stop * part(dice);
  }
}

/** Turns the contact of a slot's frame over; the frame stays valid. */
void glitch(ilk_inputs_t& inputs, std::size_t slot) {
  auto& frame = inputs.frame[slot];
  if (frame[0] == kStartWord) {
    const std::uint32_t before = frame[2];
    frame[2] ^= kSwitchOpenBit;
    frame[ILK_FRAME_WORDS - 1] += before - frame[2];
  }
}

class HomingOf : public testing::TestWithParam<std::string> {
 protected:
  /** Homes all axes with a switch at once from one seeded start each; returns how many are homed. */
  std::size_t home_once(const ilk_config_t& config, Parameters parameters, std::uint64_t seed) {
    std::mt19937_64 dice(seed);
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      const auto& axis = config.axis[slot];
      auto& plant = parameters.axis[slot];
      plant.noise_chance = 0.1;
      plant.switch_bounce = Microseconds{3000};
      if (axis.limit_side != ILK_LIMIT_NONE) {
        const auto start = static_cast<Start>((seed + slot) % static_cast<std::uint64_t>(Start::kCount));
        plant.start_counts = position_from_switch(axis, inward_counts(axis, plant, start, dice));
      }
    }
    Plant plant(config, parameters, seed);
    ilk_state_t state{};
    ilk_outputs_t outputs{};
    EXPECT_EQ(ilk_init(&config, &state).error, ILK_CONFIG_ERROR_NONE);
    std::uint32_t sequence = 0;
    const auto step = [&](ilk_request_kind_t kind, std::size_t slot = 0) {
      ilk_request_t requests[2] = {};
      requests[0].kind = ILK_REQUEST_HEARTBEAT;
      requests[1].kind = kind;
      requests[1].axis = static_cast<std::uint32_t>(slot);
      requests[1].consent = state.system.consent;
      for (auto& request : requests) {
        request.sequence = ++sequence;
        request.holder = 1;
        request.crc = ilk_request_crc(&request);
      }
      ilk_inputs_t inputs = exchange(plant, outputs, state.system.tick);
      for (std::size_t each = 0; each < ILK_SLOTS; ++each) {
        if (config.axis[each].limit_side != ILK_LIMIT_NONE && glitches(dice)) {
          glitch(inputs, each);
        }
      }
      ilk_step(&config, &state, &inputs, requests, 2, &outputs);
    };
    const auto run = [&](int ticks) {
      for (int n = 0; n < ticks; ++n) {
        step(ILK_REQUEST_HEARTBEAT);
      }
    };
    run(20);
    step(ILK_REQUEST_RESET);
    run(200);
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      step(ILK_REQUEST_ENABLE, slot);
    }
    EXPECT_TRUE(plant.schedule(command::PressPedal{true}));
    run(50);
    EXPECT_EQ(state.system.mode, ILK_MODE_MOTION);
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      step(ILK_REQUEST_HOME, slot);
    }
    const auto homing = [&] {
      for (const auto& axis : state.axis) {
        if (axis.state == ILK_AXIS_HOMING) return true;
      }
      return false;
    };
    while (homing()) {
      step(ILK_REQUEST_HEARTBEAT);
    }
    std::size_t homed = 0;
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      const auto& axis = config.axis[slot];
      if (axis.limit_side == ILK_LIMIT_NONE) {
        continue;
      }
      const auto& seen = state.axis[slot];
      if (seen.homed == ILK_HOMED_BY_SWITCH) {
        /* The counter without noise where the switch has just closed. */
        const double closed = position_from_switch(axis, -1e-6);
        const std::uint32_t truth = plant.station(slot)->card.encoder()->count(closed);
        EXPECT_LE(std::abs(static_cast<std::int32_t>(seen.home_raw - truth)), 1)
            << "slot " << slot << ", seed " << seed;
        ++homed;
      } else {
        EXPECT_EQ(seen.homed, ILK_HOMED_NOT);
        EXPECT_TRUE(state.system.mode != ILK_MODE_MOTION) << "slot " << slot << ", seed " << seed;
      }
    }
    return homed;
  }
};

TEST_P(HomingOf, EveryAxisFromEverywhereEndsWithinOneCountOfItsSwitch) {
  const auto robot = interlock::load_robot(kFolder / "robots" / (GetParam() + ".toml"));
  ASSERT_TRUE(robot);
  const auto config = compile(*robot);
  ASSERT_TRUE(config);
  const auto parameters = load_parameters(kFolder / "plant" / (GetParam() + ".toml"), *config);
  ASSERT_TRUE(parameters) << parameters.error();
  std::size_t switches = 0;
  for (const auto& axis : config->axis) {
    switches += axis.limit_side != ILK_LIMIT_NONE ? 1 : 0;
  }
  std::size_t homed = 0;
  for (std::uint64_t seed = 1; seed <= kStarts; ++seed) {
    homed += home_once(*config, *parameters, seed);
  }
  EXPECT_EQ(homed, kStarts * switches)
      << "budgets, clear distance and tolerance of the file suffice from everywhere";
}

INSTANTIATE_TEST_SUITE_P(Shipped, HomingOf, testing::Values("neuro", "prostate", "desk"),
                         [](const auto& robot) { return robot.param; });

}  // namespace
}  // namespace interlock::plant::test
