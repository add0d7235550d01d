/**
 * @file
 * The campaign itself: what makes its result worth something.
 */
#include <gmock/gmock.h>

#include <algorithm>
#include <bitset>
#include <map>
#include <set>
#include <sstream>

#include "case_file.hpp"
#include "flip.hpp"
#include "interlock/kernel.h"
#include "plan.hpp"
#include "refusal.hpp"
#include "robot.hpp"
#include "shrink.hpp"

namespace interlock::campaign {
namespace {

TEST(Campaign, P13_robots_are_valid_for_the_kernel_and_the_monitors) {
  for (std::uint64_t seed = 0; seed < 500; seed++) {
    plant::Random random(seed, 0);
    const Robot robot = make_robot(random);
    const ilk_config_verdict_t verdict = ilk_config_validate(&robot.config);
    EXPECT_EQ(verdict.error, ILK_CONFIG_ERROR_NONE) << "seed " << seed << ", slot " << verdict.slot;
    EXPECT_EQ(judge_config(&robot.config).clause, nullptr) << "seed " << seed;
  }
}

TEST(Campaign, P13_every_spoilt_configuration_breaks_a_rule_of_its_own) {
  std::set<std::uint32_t> rules;
  for (std::uint64_t seed = 0; seed < 50; seed++) {
    plant::Random random(seed, 0);
    const Robot robot = make_robot(random);
    for (std::size_t way = 0; way < spoilings(); way++) {
      const ilk_config_t wrong = spoilt(robot.config, way, random);
      const std::uint32_t error = ilk_config_validate(&wrong).error;
      EXPECT_NE(error, ILK_CONFIG_ERROR_NONE) << "seed " << seed << ", way " << way;
      rules.insert(error);
    }
  }
  EXPECT_GE(rules.size(), 18u);
}

TEST(Campaign, P13_a_kernel_that_starts_with_a_valid_configuration_is_not_taken_for_inert) {
  plant::Random random(1, 0);
  const Robot robot = make_robot(random);
  EXPECT_EQ(judge_refusals(robot.config, random), std::nullopt);
  EXPECT_FALSE(stays_inert(robot.config, 0));
}

TEST(Campaign, Draws_every_kind_of_fault_alone_and_in_pairs) {
  std::set<FaultKind> kinds;
  bool pairs = false;
  for (std::uint64_t number = 0; number < 20; number++) {
    const Case plan = make_case(7, number);
    for (std::size_t n = 0; n < plan.faults.size(); n++) {
      kinds.insert(plan.faults[n].kind);
      pairs = pairs || (n > 0 && plan.faults[n].tick == plan.faults[n - 1].tick);
    }
  }
  EXPECT_EQ(kinds.size(), kFaultKinds);
  EXPECT_TRUE(pairs);
}

TEST(Campaign, Counts_the_pairs_of_kinds_that_it_came_to) {
  Case plan;
  plan.seed = 7;
  plan.ticks = 500;
  plan.faults = {{400, FaultKind::kCardDeaf, 1, 2, 0, 0},
                 {402, FaultKind::kAppFloods, 0, 2, 0, 0},
                 {406, FaultKind::kEncoderJumps, 2, 1, 3, 0}};
  const Totals totals = run(plan).totals;
  EXPECT_EQ(totals.kind_pairs.count(), 1u);
  const auto pair = static_cast<std::size_t>(FaultKind::kCardDeaf) * kFaultKinds +
                    static_cast<std::size_t>(FaultKind::kAppFloods);
  EXPECT_TRUE(totals.kind_pairs.test(pair));
}

/** A case that fails as soon as two kinds were there, the second of them after the first. */
Outcome fails_by_two(const Case& plan) {
  Outcome outcome;
  bool deaf = false;
  for (const Fault& fault : plan.faults) {
    deaf = deaf || fault.kind == FaultKind::kCardDeaf;
    if (deaf && fault.kind == FaultKind::kAppFloods) {
      outcome.failure = Failure{fault.tick + 3, "P1: driven", 2};
      return outcome;
    }
  }
  return outcome;
}

TEST(Campaign, Shrinks_a_failing_case_to_the_faults_that_it_needs) {
  Case plan = make_case(7, 1);
  plan.faults.push_back({plan.ticks - 20, FaultKind::kCardDeaf, 1, 2, 0, 0});
  plan.faults.push_back({plan.ticks - 10, FaultKind::kAppFloods, 0, 2, 0, 0});
  const Outcome before = fails_by_two(plan);
  ASSERT_TRUE(before.failure);
  int runs = 0;
  const Case small = shrink(plan, *before.failure, [&](const Case& each) {
    runs++;
    return fails_by_two(each);
  });
  ASSERT_EQ(small.faults.size(), 2u);
  EXPECT_EQ(small.faults[0].kind, FaultKind::kCardDeaf);
  EXPECT_EQ(small.faults[1].kind, FaultKind::kAppFloods);
  EXPECT_EQ(small.ticks, small.faults[1].tick + 4);
  EXPECT_LE(runs, 300);
  std::stringstream text;
  write_case(text, small);
  const auto again = read_case(text);
  ASSERT_TRUE(again) << again.error();
  EXPECT_TRUE(fails_by_two(*again).failure);
}

TEST(Campaign, Shrinking_takes_a_failure_of_another_kind_for_none) {
  Case plan = make_case(7, 1);
  const Failure late{plan.ticks - 1, "E-stop pulled", 2};
  const Case same = shrink(plan, late, [](const Case& each) {
    Outcome outcome;
    outcome.failure = Failure{each.ticks - 1, "P3: driven", 2};
    return outcome;
  });
  EXPECT_EQ(same.faults.size(), plan.faults.size());
}

TEST(Campaign, P2_cases_one_after_the_other_sweep_stops_over_each_tick_of_a_move) {
  std::map<FaultKind, std::set<std::uint32_t>> ticks;
  for (std::uint64_t number = 0; number < 4690; number++) {
    if (sweeps_stops(number)) {
      for (const Fault& fault : make_case(11, number).faults) {
        ticks[fault.kind].insert(fault.driven_ticks);
      }
    }
  }
  EXPECT_THAT(ticks, testing::UnorderedElementsAre(testing::Key(FaultKind::kEstopPulled),
                                                   testing::Key(FaultKind::kPedalReleased)));
  for (const auto& [kind, swept] : ticks) {
    EXPECT_EQ(swept.size(), kMoveTicks) << name_of(kind);
    EXPECT_EQ(*swept.begin(), 1u) << name_of(kind);
    EXPECT_EQ(*swept.rbegin(), kMoveTicks) << name_of(kind);
  }
}

TEST(Campaign, P2_stops_of_a_sweep_come_at_their_ticks_and_are_met) {
  const Case plan = make_case(11, 4);
  const Outcome outcome = run(plan);
  std::bitset<kMoveTicks> estop;
  std::bitset<kMoveTicks> pedal;
  for (const Fault& fault : plan.faults) {
    (fault.kind == FaultKind::kEstopPulled ? estop : pedal).set(fault.driven_ticks - 1);
  }
  EXPECT_FALSE(outcome.failure) << outcome.failure->clause;
  EXPECT_EQ(outcome.totals.estop_ticks, estop);
  EXPECT_EQ(outcome.totals.pedal_ticks, pedal);
  EXPECT_EQ(outcome.totals.stops_met, plan.faults.size());
}

TEST(Campaign, P2_each_stop_of_a_sweep_ends_a_press_of_its_own) {
  const Case plan = make_case(11, 4);
  World world(plan);
  std::size_t presses = 0;
  bool was_in_motion = false;
  for (std::uint32_t tick = 0; tick < plan.ticks; tick++) {
    ASSERT_FALSE(world.step());
    const bool in_motion = world.state().system.mode == ILK_MODE_MOTION;
    presses += was_in_motion && !in_motion ? 1 : 0;
    was_in_motion = in_motion;
  }
  EXPECT_GE(presses, plan.faults.size());
}

TEST(Campaign, P14_cases_one_after_the_other_flip_each_bit_of_the_configuration) {
  std::bitset<kConfigBits> bits;
  for (std::uint64_t number = 0; number < kConfigBits / 3; number++) {
    for (const Fault& fault : make_case(11, number).faults) {
      if (fault.kind == FaultKind::kConfigBitFlips) {
        bits.set(fault.amount);
      }
    }
  }
  EXPECT_TRUE(bits.all()) << bits.count() << " of " << kConfigBits;
}

TEST(Campaign, P14_each_planned_bit_of_the_configuration_flips_although_it_waits_for_drive) {
  const Case plan = make_case(11, 3);
  std::bitset<kConfigBits> bits;
  for (const Fault& fault : plan.faults) {
    if (fault.kind == FaultKind::kConfigBitFlips) {
      bits.set(fault.amount);
    }
  }
  const Outcome outcome = run(plan);
  EXPECT_FALSE(outcome.failure) << outcome.failure->clause;
  EXPECT_GT(bits.count(), 0u);
  EXPECT_EQ(outcome.totals.config_bits, bits);
  EXPECT_TRUE(outcome.totals.config_bits_driven.any());
}

constexpr std::uint64_t kHomingCases = 40;

TEST(Campaign, P8_homings_are_given_up_for_their_travel_and_for_their_time) {
  Totals totals;
  std::uint64_t homings = 0;
  for (std::uint64_t number = 14; number < 14 + 15 * kHomingCases; number += 15) {
    ASSERT_TRUE(homes_patiently(number));
    const Outcome outcome = run(make_case(1, number));
    EXPECT_FALSE(outcome.failure) << number << ": " << outcome.failure->clause;
    totals.add(outcome.totals);
    homings += outcome.totals.homings;
  }
  EXPECT_GT(totals.axis_faults[ILK_FAULT_HOMING_TRAVEL], 0u);
  EXPECT_GT(totals.axis_faults[ILK_FAULT_HOMING_TIMEOUT], 0u);
  EXPECT_GT(homings, 0u);
}

// The stop was called late although the limit of missed deadlines was the damaged word.
TEST(Campaign, P14_a_stop_that_rests_on_a_damaged_limit_is_demanded_when_the_damage_is_met) {
  const std::uint32_t bit = offsetof(ilk_config_t, common.overrun_limit) * 8 + 16;
  // As many ticks as the configuration has slices: the damage is met at once or late.
  for (std::uint32_t tick = 1000; tick < 1000 + ILK_SLOTS; tick++) {
    const Fault flip{tick, FaultKind::kConfigBitFlips, 0, 30, bit, 0};
    const Fault overruns{tick, FaultKind::kClockOverruns, 0, 6, 0, 0};
    for (const bool flips_first : {false, true}) {
      Case plan{1, 4, 1100, flips_first ? std::vector{flip, overruns} : std::vector{overruns, flip}};
      ASSERT_TRUE(sweeps_stops(plan.number)) << "its foot stays down";
      const Outcome outcome = run(plan);
      EXPECT_FALSE(outcome.failure) << outcome.failure->clause << ", tick " << tick;
      EXPECT_GE(outcome.totals.stops_met, 2u);
    }
  }
}

TEST(Campaign, Case_runs_twice_to_the_same_bits) {
  Case plan = make_case(3, 1);
  plan.ticks = 5000;
  const Outcome first = run(plan);
  const Outcome second = run(plan);
  EXPECT_EQ(first.totals.digest, second.totals.digest);
  EXPECT_EQ(first.totals.moves_accepted, second.totals.moves_accepted);
  plan.seed = 4;
  EXPECT_NE(run(plan).totals.digest, first.totals.digest);
}

TEST(Campaign, Moves_the_robot_and_demands_stops) {
  const Outcome outcome = run(make_case(3, 2));
  EXPECT_FALSE(outcome.failure) << outcome.failure->clause;
  EXPECT_GT(outcome.totals.motion_ticks, outcome.totals.ticks / 10);
  EXPECT_GT(outcome.totals.driven_axis_ticks, outcome.totals.ticks / 2);
  EXPECT_GT(outcome.totals.moves_accepted, 500u);
  EXPECT_GT(outcome.totals.stops_met, 50u);
}

TEST(Campaign, P14_flip_changes_one_bit_and_back) {
  plant::Random random(1, 0);
  ilk_config_t config = make_robot(random).config;
  const std::uint32_t before = config.axis[3].max_drive;
  const std::size_t bit = (offsetof(ilk_config_t, axis[3].max_drive)) * 8 + 5;
  flip(config, bit);
  EXPECT_EQ(config.axis[3].max_drive, before ^ 1u << 5);
  flip(config, bit);
  EXPECT_EQ(config.axis[3].max_drive, before);
}

TEST(CaseFile, Reads_what_it_wrote) {
  const Case plan = make_case(5, 9);
  ASSERT_TRUE(sweeps_stops(plan.number)) << "has faults that wait for their tick of a press";
  std::stringstream text;
  write_case(text, plan);
  const auto read = read_case(text);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->seed, plan.seed);
  EXPECT_EQ(read->number, plan.number);
  EXPECT_EQ(read->ticks, plan.ticks);
  ASSERT_EQ(read->faults.size(), plan.faults.size());
  EXPECT_EQ(read->faults.back().kind, plan.faults.back().kind);
  EXPECT_EQ(read->faults.back().amount, plan.faults.back().amount);
  EXPECT_EQ(read->faults.back().driven_ticks, plan.faults.back().driven_ticks);
}

TEST(CaseFile, Names_the_line_that_it_does_not_understand) {
  std::stringstream text("interlock campaign case 2\nseed 1\nfault 5 99 0 0 0 0\n");
  const auto read = read_case(text);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), testing::StartsWith("line 3:"));
}

}  // namespace
}  // namespace interlock::campaign
