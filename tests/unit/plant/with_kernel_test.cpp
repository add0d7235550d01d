/**
 * @file
 * The kernel core and the plant of the NeuroRobot in one process: two codecs and two ideas of direction,
 * switch and coasting that have to agree.
 */
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "interlock/kernel.h"
#include "plant/exchange.hpp"
#include "plant/parameters_file.hpp"
#include "plant/plant.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

namespace interlock::plant::test {
namespace {

const std::filesystem::path kModels = INTERLOCK_MODELS;

constexpr std::size_t kAxes[] = {0, 1, 2, 3, 4, 6, 7};
constexpr std::size_t kLateral = 4;

ilk_config_t neuro_robot() {
  const auto robot = interlock::load_robot(kModels / "robots" / "neuro.toml");
  EXPECT_TRUE(robot);
  const auto config = compile(*robot);
  EXPECT_TRUE(config);
  return *config;
}

Parameters neuro_plant(const ilk_config_t& robot) {
  const auto parameters = load_parameters(kModels / "plant" / "neuro.toml", robot);
  EXPECT_TRUE(parameters) << parameters.error();
  return *parameters;
}

/** Steps kernel and plant in turn, as the executive does, and plays an app that stays alive. */
class Pair {
 public:
  explicit Pair(std::uint64_t seed = 1) : config(neuro_robot()), plant(config, neuro_plant(config), seed) {
    EXPECT_EQ(ilk_init(&config, &state).error, ILK_CONFIG_ERROR_NONE);
    run(20);
  }

  void ask(ilk_request_kind_t kind, std::size_t slot = 0, std::int32_t target = 0, std::uint32_t drive = 0) {
    ilk_request_t request{};
    request.sequence = ++sequence_;
    request.kind = kind;
    request.axis = static_cast<std::uint32_t>(slot);
    request.target_counts = target;
    request.drive = drive;
    request.lease_ticks = config.common.lease_max_ticks;
    request.holder = 1;
    request.consent = state.system.consent;
    request.crc = ilk_request_crc(&request);
    requests_.push_back(request);
  }

  /** One tick; every request must be accepted. */
  void step() {
    ask(ILK_REQUEST_HEARTBEAT);
    const ilk_inputs_t inputs = exchange(plant, outputs, state.system.tick);
    ilk_step(&config, &state, &inputs, requests_.data(), static_cast<std::uint32_t>(requests_.size()),
             &outputs);
    for (std::uint32_t n = 0; n < outputs.verdict_count; ++n) {
      EXPECT_EQ(outputs.verdict[n].verdict, ILK_VERDICT_ACCEPTED)
          << "request kind " << outputs.verdict[n].kind << ", axis " << outputs.verdict[n].axis;
    }
    requests_.clear();
  }

  void run(int ticks) {
    for (int n = 0; n < ticks; ++n) {
      step();
    }
  }

  void apply(const command::Command& command) { EXPECT_TRUE(plant.schedule(command)); }

  /** Unlocks, enables every axis, which rests with its power up, and holds the pedal. */
  void start() {
    ask(ILK_REQUEST_RESET);
    run(100);
    for (const std::size_t slot : kAxes) {
      ask(ILK_REQUEST_ENABLE, slot);
    }
    run(1);
    press();
  }

  void press() {
    apply(command::PressPedal{true});
    run(50);
    ASSERT_EQ(state.system.mode, ILK_MODE_MOTION);
  }

  /** Homes an axis by its switch. */
  void home(std::size_t slot) {
    ask(ILK_REQUEST_HOME, slot);
    run(1);
    while (state.axis[slot].state == ILK_AXIS_HOMING) {
      step();
    }
    ASSERT_EQ(state.axis[slot].homed, ILK_HOMED_BY_SWITCH)
        << "slot " << slot << ", fault " << state.axis[slot].fault;
  }

  double true_position(std::size_t slot) const { return plant.station(slot)->position_counts(); }

  ilk_config_t config;
  ilk_state_t state{};
  ilk_outputs_t outputs{};
  Plant plant;

 private:
  std::uint32_t sequence_ = 0;
  std::vector<ilk_request_t> requests_;
};

TEST(PlantWithKernel, EveryAxisWithASwitchHomesWhereItsSwitchIs) {
  Pair pair;
  pair.start();
  for (const std::size_t slot : kAxes) {
    if (pair.config.axis[slot].limit_side != ILK_LIMIT_NONE) {
      pair.home(slot);
      EXPECT_NEAR(pair.state.axis[slot].position_counts, pair.true_position(slot), 2) << "slot " << slot;
    }
  }
}

TEST(PlantWithKernel, P4_FullDriveIntoEitherLimitStaysWithinTheSoftRange) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Pair pair(seed);
    pair.start();
    pair.home(kLateral);
    const ilk_axis_config_t& axis = pair.config.axis[kLateral];
    const ilk_reach_t reach = ilk_reach(&axis, &pair.state.axis[kLateral]);
    for (const auto target : {static_cast<std::int32_t>(reach.low), static_cast<std::int32_t>(reach.high)}) {
      for (int n = 0; n < 3000; ++n) {
        if (n % 50 == 0) {
          pair.ask(ILK_REQUEST_MOVE, kLateral, target, axis.max_drive);
        }
        pair.step();
        ASSERT_GE(pair.true_position(kLateral), axis.min_counts);
      }
      EXPECT_NEAR(pair.state.axis[kLateral].position_counts, target, axis.coast_counts);
    }
    EXPECT_EQ(pair.state.axis[kLateral].fault, ILK_FAULT_NONE);
  }
}

TEST(PlantWithKernel, EachFaultOfThePlantIsTheFaultThatTheKernelNames) {
  const auto fault_after = [](const command::Command& command) {
    Pair pair;
    pair.start();
    pair.home(kLateral);
    for (int n = 0; n < 1500; ++n) {
      const bool faulted = pair.state.axis[kLateral].state == ILK_AXIS_FAULTED;
      if (pair.state.system.mode == ILK_MODE_MOTION && !faulted && n % 50 == 0) {
        pair.ask(ILK_REQUEST_MOVE, kLateral, -2000, pair.config.axis[kLateral].max_drive / 2);
      }
      if (n == 210) {
        pair.apply(command);
      }
      pair.step();
    }
    return pair.state.axis[kLateral].fault;
  };
  EXPECT_EQ(fault_after(command::JamAxis{kLateral, true}), ILK_FAULT_STALL);
  EXPECT_EQ(fault_after(command::StickEncoder{kLateral, true}), ILK_FAULT_STALL);
  EXPECT_EQ(fault_after(command::ReverseMotor{kLateral, true}), ILK_FAULT_REVERSE);
  EXPECT_EQ(fault_after(command::JumpCounter{kLateral, 500}), ILK_FAULT_JUMP);
  EXPECT_EQ(fault_after(command::PowerCard{kLateral, false}), ILK_FAULT_CARD);
  EXPECT_EQ(fault_after(command::SpoilFrames{kLateral, FrameFault::kCorrupt, 3}), ILK_FAULT_CARD);
  EXPECT_EQ(fault_after(command::SpoilFrames{kLateral, FrameFault::kDelay, 3}), ILK_FAULT_CARD);
  EXPECT_EQ(fault_after(command::SpoilFrames{kLateral, FrameFault::kRepeat, 3}), ILK_FAULT_CARD);
  EXPECT_EQ(fault_after(command::SpoilFrames{kLateral, FrameFault::kDeaf, 3}), ILK_FAULT_CARD);
  EXPECT_EQ(fault_after(command::SpoilFrames{kLateral, FrameFault::kDrop, 2}), ILK_FAULT_NONE);
}

TEST(PlantWithKernel, RunawayOfAnAxisThatIsNotDrivenIsADrift) {
  Pair pair;
  pair.start();
  pair.home(kLateral);
  pair.run(200);
  pair.apply(command::RunAway{kLateral, -0.5});
  pair.run(200);
  EXPECT_EQ(pair.state.axis[kLateral].fault, ILK_FAULT_DRIFT);
}

TEST(PlantWithKernel, P2_PedalAndEstopEdgesReachTheWireWithinTwoTicks) {
  for (int phase = 0; phase < 40; ++phase) {
    const bool by_pedal = phase % 2 == 0;
    Pair pair(static_cast<std::uint64_t>(phase));
    pair.start();
    pair.home(kLateral);
    pair.ask(ILK_REQUEST_MOVE, kLateral, -2000, pair.config.axis[kLateral].max_drive);
    pair.run(50 + phase);
    if (by_pedal) {
      pair.apply(command::PressPedal{false});
    } else {
      pair.apply(command::PullEstop{true});
    }
    pair.run(20);
    const Record& record = pair.plant.record();
    const auto edge = record.newest(by_pedal ? Event::kPedalReleased : Event::kEstopPulled);
    ASSERT_TRUE(edge);
    EXPECT_LE(*record.newest(Event::kLastNonzeroDrive), *edge + 1) << "phase " << phase;
    EXPECT_GE(*record.newest(Event::kLastNonzeroDrive) + 2, *edge) << "it was moving, phase " << phase;
  }
}

}  // namespace
}  // namespace interlock::plant::test
