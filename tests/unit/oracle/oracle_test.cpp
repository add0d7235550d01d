/**
 * @file
 * For each property a stream of frames with one unsafe output that the oracle must report, and the same
 * stream without it, on which it must be silent.
 */
#include "oracle/oracle.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "stage.hpp"

namespace interlock::oracle::test {
namespace {

struct Case {
  std::string name;
  Property property;
  std::function<void(Stage&, bool seeded)> run;
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

void play_move(Stage& stage, std::int32_t target, std::uint32_t lease_ticks) {
  stage.drive(target > 0 ? kDrive : -std::int64_t{kDrive});
  stage.prepare();
  stage.say_move(target, lease_ticks);
  stage.seal_all();
  stage.play();
}

void come_to_drive(Stage& stage) {
  stage.come_to_ready();
  stage.come_to_motion();
  play_move(stage, 60, 100);
}

/** Lets axis 0 move with its drive, a count a tick. */
void run_moving(Stage& stage, std::uint32_t ticks, std::int32_t step = 1) {
  for (std::uint32_t tick = 0; tick < ticks; tick++) {
    stage.counter += static_cast<std::uint32_t>(step);
    stage.truth += step;
    stage.run(1);
  }
}

void claim_fault(Stage& stage, std::uint32_t code) {
  stage.drive(0);
  stage.claim.mode = Mode::kReady;
  stage.claim.axes[0].mode = AxisMode::kFaulted;
  stage.claim.axes[0].fault = code;
  stage.claim.axes[0].homed = false;
}

/** Takes the frames of axis 0 away until its card is lost, which the system claims or not. */
void lose_card(Stage& stage, bool claimed = true) {
  for (int tick = 0; tick < 3; tick++) {
    if (tick == 2 && claimed) {
      claim_fault(stage, 4);
    }
    stage.prepare();
    stage.seen.received[0] = false;
    stage.seal_all();
    stage.play();
  }
}

/** Acknowledges the fault of axis 0 and enables it, in one tick. */
void enable_again(Stage& stage) {
  stage.claim.axes[0].mode = AxisMode::kEnabled;
  stage.claim.axes[0].fault = 0;
  stage.prepare();
  stage.say(Order::kClearFault);
  stage.say(Order::kEnable);
  stage.seal_all();
  stage.play();
}

const Case kCases[] = {
    {"P1_lease_ran_out", Property::kP1,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       play_move(stage, 60, 10);
       run_moving(stage, 9);
       stage.drive(seeded ? kDrive : 0);
       run_moving(stage, 1);
     }},
    {"P1_card_invalid", Property::kP1,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.drive(seeded ? kDrive : 0);
       stage.prepare();
       stage.from_card[0][11]--;
       stage.seal_all();
       stage.play();
     }},
    {"P1_not_enabled", Property::kP1,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.drive(seeded ? kDrive : 0);
       stage.claim.axes[0].mode = AxisMode::kDisabled;
       stage.prepare();
       stage.say(Order::kDisable);
       stage.seal_all();
       stage.play();
     }},
    {"P1_away_from_setpoint", Property::kP1,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.drive(seeded ? -std::int64_t{kDrive} : kDrive);
       stage.run(1);
     }},
    {"P1_lost_card_unnoticed", Property::kP1,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       lose_card(stage, !seeded);
     }},
    {"P2_pedal_released", Property::kP2,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.release();
       stage.claim.mode = Mode::kReady;
       stage.drive(seeded ? kDrive : 0);
       stage.run(1);
     }},
    {"P2_one_contact_released", Property::kP2,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.claim.mode = Mode::kReady;
       stage.drive(seeded ? kDrive : 0);
       stage.prepare();
       stage.seen.pedal_normally_closed = Contact::kClosed;
       stage.seal_all();
       stage.play();
     }},
    {"P2_estop", Property::kP2,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.claim.mode = Mode::kLocked;
       stage.claim.axes[0].mode = AxisMode::kDisabled;
       stage.drive(seeded ? kDrive : 0);
       stage.prepare();
       stage.seen.estop_loop = Contact::kUndefined;
       stage.seal_all();
       stage.play();
     }},
    {"P2_estop_not_latched", Property::kP2,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       if (!seeded) {
         stage.claim.mode = Mode::kLocked;
         stage.claim.axes[0].mode = AxisMode::kDisabled;
       }
       stage.prepare();
       stage.seen.estop_loop = Contact::kOpen;
       stage.seal_all();
       stage.play();
     }},
    {"P2_overruns_not_latched", Property::kP2,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       for (int tick = 0; tick < 3; tick++) {
         if (tick == 2 && !seeded) {
           stage.claim.mode = Mode::kLocked;
           stage.claim.axes[0].mode = AxisMode::kDisabled;
         }
         stage.prepare();
         stage.seen.deadline_missed = true;
         stage.seal_all();
         stage.play();
       }
     }},
    {"P2_required_card", Property::kP2,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       for (int tick = 0; tick < 3; tick++) {
         if (tick == 2 && !seeded) {
           stage.claim.mode = Mode::kReady;
           stage.drive(0);
         }
         stage.prepare();
         stage.seen.received[2] = false;
         stage.seal_all();
         stage.play();
       }
     }},
    {"P2_stop_request", Property::kP2,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       if (!seeded) {
         stage.claim.mode = Mode::kReady;
         stage.drive(0);
       }
       stage.prepare();
       stage.say(Order::kStop);
       stage.seal_all();
       stage.play();
     }},
    {"P3_towards_its_switch", Property::kP3,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       stage.triggered = true;
       play_move(stage, seeded ? 60 : -60, 100);
     }},
    {"P4_driven_beyond_limit_less_coast", Property::kP4,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.home_at(980);
       stage.come_to_motion();
       play_move(stage, 990, 100);
       stage.drive(0);
       run_moving(stage, 11);
       stage.drive(seeded ? kDrive : 0);
       stage.run(1);
     }},
    {"P4_axis_leaves_its_soft_range", Property::kP4,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.home_at(990);
       run_moving(stage, seeded ? 11 : 10);
     }},
    {"P5_driven_without_progress", Property::kP5,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.run(49);
       if (!seeded) {
         claim_fault(stage, 5);
       }
       stage.run(1);
     }},
    {"P5_new_move_is_no_progress", Property::kP5,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       for (int tick = 0; tick < 48; tick++) {
         play_move(stage, 60 - tick % 2, 100);
       }
       run_moving(stage, 1, seeded ? 0 : 3);
       stage.run(30);
     }},
    {"P6_jump", Property::kP6,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.counter += seeded ? 21 : 11;
       stage.run(1);
     }},
    {"P6_reverse", Property::kP6,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       run_moving(stage, 20);
       run_moving(stage, seeded ? 16 : 15, -1);
     }},
    {"P6_drift", Property::kP6,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.run(10);
       run_moving(stage, seeded ? 16 : 15);
     }},
    // The axis may have been moved by hand: its drift is measured from where the card found it again.
    {"P6_drift_after_a_lost_card", Property::kP6,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.run(10);
       run_moving(stage, 10);
       lose_card(stage);
       enable_again(stage);
       stage.run(1);
       run_moving(stage, seeded ? 16 : 15);
     }},
    {"P7_drive_above_its_bound", Property::kP7,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       stage.drive(seeded ? kMaxDrive / 10 + 1 : kMaxDrive / 10);
       stage.prepare();
       stage.say_move(60, 100, kMaxDrive / 10);
       stage.seal_all();
       stage.play();
     }},
    {"P7_unhomed_travel", Property::kP7,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       play_move(stage, 90, 100);
       run_moving(stage, 87);
       stage.drive(0);
       run_moving(stage, 3);
       stage.drive(seeded ? kDrive : 0);
       run_moving(stage, 1);
     }},
    {"P7_homed_without_cause", Property::kP7,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.claim.axes[0].homed = seeded;
       stage.run(1);
     }},
    {"P8_locked_left_without_reset", Property::kP8,
     [](Stage& stage, bool seeded) {
       stage.claim.mode = Mode::kLocked;
       stage.run(5);
       stage.claim.mode = Mode::kReady;
       stage.prepare();
       if (!seeded) {
         stage.say(Order::kReset);
       }
       stage.seal_all();
       stage.play();
     }},
    {"P8_first_cause_overwritten", Property::kP8,
     [](Stage& stage, bool seeded) {
       stage.claim.mode = Mode::kLocked;
       stage.claim.first_cause = 1;
       stage.run(2);
       stage.claim.first_cause = seeded ? 2 : 1;
       stage.run(1);
     }},
    {"P8_fault_left_by_itself", Property::kP8,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       claim_fault(stage, 5);
       stage.run(3);
       stage.claim.axes[0].mode = AxisMode::kDisabled;
       stage.claim.axes[0].fault = 0;
       stage.prepare();
       if (!seeded) {
         stage.say(Order::kClearFault);
       }
       stage.seal_all();
       stage.play();
     }},
    {"P8_reset_with_the_pedal_down", Property::kP8,
     [](Stage& stage, bool seeded) {
       stage.claim.mode = Mode::kLocked;
       stage.run(5);
       if (seeded) {
         stage.press();
       }
       stage.claim.mode = Mode::kReady;
       stage.prepare();
       stage.say(Order::kReset);
       stage.seal_all();
       stage.play();
     }},
    {"P9_press_without_release_in_ready", Property::kP9,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       stage.claim.mode = Mode::kReady;
       stage.release();
       stage.run(seeded ? 9 : 11);
       stage.come_to_motion();
     }},
    {"P9_press_not_debounced", Property::kP9,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.press();
       stage.run(seeded ? 8 : 9);
       stage.claim.mode = Mode::kMotion;
       stage.run(1);
     }},
    {"P9_other_holder", Property::kP9,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       if (!seeded) {
         stage.claim.mode = Mode::kReady;
         stage.drive(0);
       }
       stage.prepare();
       stage.say(Order::kHeartbeat).holder = 8;
       stage.seal_all();
       stage.play();
     }},
    {"P10_app_silent", Property::kP10,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       stage.app_speaks = false;
       stage.run(99);
       stage.claim.mode = seeded ? Mode::kMotion : Mode::kReady;
       stage.run(1);
     }},
    {"P11_damaged_request_accepted", Property::kP11,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.prepare();
       Message& message = stage.say(Order::kStop);
       message.intact = false;
       message.answer = seeded ? Answer::kAccepted : Answer::kRefused;
       stage.seal_all();
       stage.play();
     }},
    {"P11_old_sequence_number_accepted", Property::kP11,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.prepare();
       Message& message = stage.say(Order::kStop);
       message.sequence -= seeded ? 1 : 0;
       stage.seal_all();
       stage.play();
     }},
    {"P11_verdict_missing", Property::kP11,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.prepare();
       stage.seen.answers -= seeded ? 1 : 0;
       stage.seal_all();
       stage.play();
     }},
    {"P11_refused_move_drives", Property::kP11,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.come_to_motion();
       stage.drive(seeded ? kDrive : 0);
       stage.prepare();
       stage.say_move(60, 50).answer = Answer::kRefused;
       stage.seal_all();
       stage.play();
     }},
    {"P12_old_lease_after_new_press", Property::kP12,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.drive(0);
       stage.release();
       stage.claim.mode = Mode::kReady;
       stage.run(12);
       stage.come_to_motion();
       stage.drive(seeded ? kDrive : 0);
       stage.run(1);
     }},
    {"P12_move_accepted_in_ready", Property::kP12,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.prepare();
       stage.say_move(60, 50).answer = seeded ? Answer::kAccepted : Answer::kRefused;
       stage.seal_all();
       stage.play();
     }},
    {"P13_init_left_for_ready", Property::kP13,
     [](Stage& stage, bool seeded) {
       stage.app_speaks = false;
       stage.run(1);
       stage.claim.mode = seeded ? Mode::kReady : Mode::kLocked;
       stage.run(1);
     }},
    {"P13_changed_configuration", Property::kP13,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       for (std::uint32_t tick = 1; tick <= 11; tick++) {
         if (tick == 11 && !seeded) {
           stage.claim.mode = Mode::kLocked;
           stage.claim.axes[0].mode = AxisMode::kDisabled;
         }
         stage.prepare();
         stage.seen.configuration_damage_ticks = tick;
         stage.seal_all();
         stage.play();
       }
     }},
    {"P14_damage_changes_an_output", Property::kP14,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.drive(seeded ? kDrive - 1 : kDrive);
       stage.prepare();
       stage.seal_all();
       std::array<Words, kSlots> twin = stage.to_card;
       twin[0][3] = kDrive;
       seal(twin[0]);
       const std::vector<wire::FrameView> frames(twin.begin(), twin.end());
       stage.seen.undamaged = frames;
       stage.seen.state_damaged = true;
       stage.play();
     }},
    {"P16_frame_of_another_tick", Property::kP16,
     [](Stage& stage, bool seeded) {
       stage.come_to_ready();
       stage.prepare();
       stage.to_card[0][13] -= seeded ? 1 : 0;
       stage.seal_all();
       stage.play();
     }},
    {"P16_drive_to_a_sensor_card", Property::kP16,
     [](Stage& stage, bool seeded) {
       come_to_drive(stage);
       stage.prepare();
       stage.to_card[2][14] = seeded ? 1 : 0;
       stage.seal_all();
       stage.play();
     }},
};

class OracleOn : public testing::TestWithParam<Case> {};

TEST_P(OracleOn, ReportsTheUnsafeOutput) {
  Stage stage;
  GetParam().run(stage, true);
  EXPECT_THAT(stage.found, testing::Contains(GetParam().property));
}

TEST_P(OracleOn, IsSilentWithoutIt) {
  Stage stage;
  GetParam().run(stage, false);
  EXPECT_THAT(stage.found, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Streams, OracleOn, testing::ValuesIn(kCases),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

TEST(Oracle, P13_judges_the_configuration_by_its_own_rules) {
  for (const bool permitted : {true, false}) {
    SystemRules rules = stage_rules();
    rules.app_timeout_ticks = permitted ? 150 : 151;
    Oracle oracle(rules);
    Stage frames;
    frames.prepare();
    frames.seal_all();
    for (std::size_t slot = 0; slot < kSlots; slot++) {
      frames.seen.from_card[slot] = frames.from_card[slot];
      frames.seen.to_card[slot] = frames.to_card[slot];
    }
    frames.seen.claim.mode = Mode::kLocked;
    const std::span<const Finding> findings = oracle.step(frames.seen);
    EXPECT_EQ(findings.empty(), permitted);
    if (!permitted) {
      EXPECT_EQ(findings.front().property, Property::kP13);
    }
  }
}

}  // namespace
}  // namespace interlock::oracle::test
