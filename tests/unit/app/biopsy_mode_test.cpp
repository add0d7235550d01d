#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "closed_loop.hpp"
#include "counted_allocations.hpp"
#include "modes/biopsy/mode.hpp"
#include "needle/scene.hpp"
#include "plant/parameters_file.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::minute_ticks;
using test::prostate;

constexpr std::uint32_t needle_push = 1;
constexpr std::uint32_t needle_spin = 0;
constexpr std::uint32_t force_card = 3;
constexpr double tick_s = 0.001;

const plant::Parameters& prostate_plant() {
  static const plant::Parameters parameters = [] {
    auto loaded =
        plant::load_parameters(INTERLOCK_ROBOTS "/../plant/prostate.toml", test::config_of(prostate()));
    loaded->axis[needle_push].start_counts = 19.0 * prostate().at_slot(needle_push)->counts_per_unit;
    return *loaded;
  }();
  return parameters;
}

ForceCalibration calibration(const SensorChannel& channel) {
  return *ForceCalibration::create(channel, prostate().biopsy->units_per_newton);
}

class BiopsyModeTest : public testing::Test {
 protected:
  /** The needle stands a millimetre in front of the skin, in MOTION. */
  explicit BiopsyModeTest(std::uint32_t latency = 2) : loop_(5, latency, prostate(), prostate_plant()) {
    loop_.plant().surround(std::make_unique<needle::Scene>(*prostate_plant().scene, 5));
    for (const std::uint32_t slot : {needle_push, needle_spin}) {
      loop_.request(ILK_REQUEST_SET_HOME, slot);
      loop_.request(ILK_REQUEST_ENABLE, slot);
    }
    loop_.pedal(true);
  }

  /** The insertion was homed where it stands, so that it begins at 0: the skin is a millimetre on. */
  [[nodiscard]] Biopsy biopsy() const {
    Biopsy described = *prostate().biopsy;
    described.entry_mm = 1.0;
    return described;
  }

  void begin(const Eigen::Vector3d& target_mm = {3.0, -2.0, 70.0}) {
    const std::vector<double> membranes{25.0, 50.0};
    auto made = make_biopsy_run(biopsy(), tick_s, {loop_.seen_tick(), 0.0, 0.0, target_mm, membranes},
                                calibration(biopsy().hand), calibration(biopsy().needle));
    ASSERT_TRUE(made) << made.error().message();
    run_ = std::make_shared<BiopsyRun>(std::move(*made));
    loop_.give(1, BiopsyTask{run_});
  }

  void press_hand(double newtons) { loop_.happen(plant::command::PressHand{newtons}); }

  [[nodiscard]] std::uint32_t push_drive() const { return loop_.outputs().command[needle_push].drive; }
  [[nodiscard]] std::uint32_t spin_drive() const { return loop_.outputs().command[needle_spin].drive; }
  [[nodiscard]] const TaskStatus& order() const { return loop_.biopsy().status(); }
  [[nodiscard]] plant::NeedleTruth truth() { return loop_.plant().surroundings()->truth(); }

  /** Hands on each image as it arrives. */
  void pass_images() {
    const auto& image = loop_.plant().surroundings()->newest_image();
    if (!image || image->time_s <= shown_s_) {
      return;
    }
    shown_s_ = image->time_s;
    // Plant and kernel count the same ticks.
    const double time_s = image->time_s - run_->start_tick * tick_s;
    if (time_s > 0.0) {
      loop_.show({1,
                  {time_s, Eigen::Map<const Eigen::Vector3d>(image->tip_mm.data()),
                   Eigen::Map<const Eigen::Vector3d>(image->target_mm.data())}});
    }
  }

  void run_to_end(std::uint32_t most_ticks) {
    for (std::uint32_t i = 0; i < most_ticks && loop_.biopsy().is_open(); ++i) {
      loop_.tick();
      pass_images();
    }
  }

  /** An image of now, of the tip where the steering believes it to be, and this far beside. */
  void show_tip_beside(double beside_mm) {
    const Eigen::Vector3d tip = run_->compensator.tip().guide_from_tip.translation();
    loop_.show({1,
                {(loop_.seen_tick() - run_->start_tick) * tick_s, tip + Eigen::Vector3d(beside_mm, 0.0, 0.0),
                 std::nullopt}});
    loop_.run(20);
  }

  ClosedLoop loop_;
  std::shared_ptr<BiopsyRun> run_;
  double shown_s_ = 0.0;
};

TEST_F(BiopsyModeTest, AHandThatPressedWhenThePedalWasPressedIsFollowedOnceItHasLetGo) {
  press_hand(3.0);
  loop_.run(50);
  begin();
  loop_.run(2000);
  EXPECT_TRUE(loop_.biopsy().now().waits_for_hand);
  EXPECT_NEAR(loop_.state().axis[needle_push].position_counts, 0, 20);
  press_hand(0.0);
  loop_.run(50);
  EXPECT_FALSE(loop_.biopsy().now().waits_for_hand);
  press_hand(3.0);
  loop_.run(1000);
  EXPECT_GT(loop_.state().axis[needle_push].position_counts, 1000);
  loop_.pedal(false);
  loop_.pedal(true);
  loop_.run(50);
  EXPECT_TRUE(loop_.biopsy().now().waits_for_hand) << "each press of the pedal for itself";
}

TEST_F(BiopsyModeTest, ASliderThatIsMovedEndsItWhetherOrNotItIsEnabled) {
  constexpr std::uint32_t slider = 2;
  begin();
  loop_.give(2, BiopsyTask{run_}, {{slider, loop_.state().axis[slider].position_counts}, {needle_push, 77}});
  press_hand(5.0);
  loop_.run(500);
  ASSERT_TRUE(loop_.biopsy().is_open()) << order().slot;
  loop_.happen(plant::command::PushAxis{slider, 200});
  loop_.run(500);
  EXPECT_EQ(order().reason, TaskReason::moved_away);
  EXPECT_EQ(order().slot, slider);
  EXPECT_EQ(push_drive(), 0u);
}

TEST_F(BiopsyModeTest, AHandAtRestMovesNothing) {
  begin();
  press_hand(0.8);
  loop_.run(2000);
  EXPECT_EQ(order().phase, TaskPhase::executing);
  EXPECT_NEAR(loop_.state().axis[needle_push].position_counts, 0, 20);
  EXPECT_NEAR(loop_.state().axis[needle_spin].position_counts, 0, 2);
}

TEST_F(BiopsyModeTest, TheHarderTheHandTheFasterTheNeedleUpToItsBound) {
  begin();
  const auto speed_at = [&](double newtons) {
    press_hand(newtons);
    loop_.run(500);
    const double before = loop_.true_position(needle_push);
    loop_.run(1000);
    return (loop_.true_position(needle_push) - before) / prostate().at_slot(needle_push)->counts_per_unit;
  };
  EXPECT_NEAR(speed_at(2.0), 1.0, 0.1);
  EXPECT_NEAR(speed_at(4.0), 3.0, 0.2);
  EXPECT_NEAR(speed_at(20.0), 5.0, 0.3);
  EXPECT_NEAR(speed_at(0.0), 0.0, 0.02);
  EXPECT_EQ(loop_.refusals(), 0u);
}

TEST_F(BiopsyModeTest, InsertionStopsWhenForceIsOlderThan20Ms) {
  begin();
  press_hand(5.0);
  loop_.run(3000);
  ASSERT_GT(push_drive(), 0u);
  loop_.happen(plant::command::SpoilFrames{force_card, plant::FrameFault::kDrop, 100'000});
  for (std::uint32_t silent = 0; silent < 20; ++silent) {
    loop_.tick();
  }
  for (std::uint32_t i = 0; i < 200; ++i) {
    loop_.tick();
    ASSERT_EQ(push_drive(), 0u) << i;
    ASSERT_EQ(spin_drive(), 0u) << i;
  }
  EXPECT_EQ(order().phase, TaskPhase::aborted);
  EXPECT_EQ(order().reason, TaskReason::force_stale);
  EXPECT_EQ(loop_.biopsy().status().slot, force_card);
}

TEST_F(BiopsyModeTest, AnAppThatFallsSilentPushesNoLongerThanItsLeaseOf10Ms) {
  begin();
  press_hand(5.0);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    loop_.tick();
    ASSERT_LE(loop_.state().axis[needle_push].lease_ticks * tick_s, 0.010) << i;
  }
  ASSERT_GT(push_drive(), 0u);
  loop_.silence(true);
  loop_.run(10);
  for (std::uint32_t i = 0; i < 50; ++i) {
    loop_.tick();
    ASSERT_EQ(push_drive(), 0u) << i;
  }
}

TEST_F(BiopsyModeTest, AFewLostReadingsDoNotStopIt) {
  begin();
  press_hand(5.0);
  loop_.run(1000);
  loop_.happen(plant::command::SpoilFrames{force_card, plant::FrameFault::kCorrupt, 5});
  loop_.run(100);
  EXPECT_EQ(order().phase, TaskPhase::executing);
}

TEST_F(BiopsyModeTest, ReleaseStopsInTheSameTickAndTheNextPressGoesOn) {
  begin();
  press_hand(5.0);
  loop_.run(2000);
  loop_.happen(plant::command::PressPedal{false});
  loop_.run(5);
  EXPECT_EQ(push_drive(), 0u);
  loop_.run(300);
  EXPECT_EQ(order().phase, TaskPhase::paused);
  const double paused_at = loop_.true_position(needle_push);
  loop_.run(500);
  EXPECT_NEAR(loop_.true_position(needle_push), paused_at, 1.0);
  press_hand(0.0);
  loop_.pedal(true);
  press_hand(5.0);
  loop_.run(1000);
  EXPECT_EQ(order().phase, TaskPhase::executing);
  EXPECT_GT(loop_.true_position(needle_push), paused_at + 3000);
}

TEST_F(BiopsyModeTest, WhileTheBreathingGateIsClosedTheHandPushesNothingAndItGoesOnWhenItOpens) {
  begin();
  press_hand(5.0);
  loop_.run(1000);
  const std::int32_t begun = loop_.state().axis[needle_push].position_counts;
  ASSERT_GT(begun, 500);
  loop_.hold({.insertion = true});
  loop_.run(500);
  const std::int32_t held = loop_.state().axis[needle_push].position_counts;
  loop_.run(6000);
  EXPECT_NEAR(loop_.state().axis[needle_push].position_counts, held, 20);
  EXPECT_EQ(order().phase, TaskPhase::executing);
  EXPECT_EQ(order().reason, TaskReason::breathing);
  loop_.hold({});
  loop_.run(500);
  EXPECT_GT(loop_.state().axis[needle_push].position_counts, held + 100);
  EXPECT_EQ(order().reason, TaskReason::none);
}

TEST_F(BiopsyModeTest, ItCanBeEndedAtAnyTick) {
  for (const std::uint32_t ticks : {1u, 100u, 1003u, 2500u}) {
    begin();
    press_hand(5.0);
    loop_.run(ticks);
    loop_.cancel(1);
    loop_.run(4);
    EXPECT_EQ(push_drive(), 0u) << ticks;
    EXPECT_EQ(spin_drive(), 0u) << ticks;
    EXPECT_EQ(order().reason, TaskReason::cancelled);
  }
}

TEST_F(BiopsyModeTest, TheTipMeetsAShiftedTargetAndEachMembraneIsFound) {
  begin();
  press_hand(5.0);
  loop_.run(2000);
  loop_.happen(plant::command::ShiftTarget{{-4.0, 3.0, 0.0}});
  bool waited = false;
  for (std::uint32_t i = 0; i < 2 * minute_ticks && loop_.biopsy().is_open(); ++i) {
    loop_.tick();
    pass_images();
    const bool waits = loop_.biopsy().now().images_disagree;
    if (waits && !waited) {
      press_hand(0.0);
    } else if (waited && !waits) {
      press_hand(5.0);
    }
    waited = waits;
  }
  ASSERT_EQ(order().phase, TaskPhase::done)
      << static_cast<int>(order().reason) << " " << loop_.biopsy().findings().quantity << " depth "
      << truth().depth_mm;
  const plant::NeedleTruth end = truth();
  const double miss_mm = std::hypot(end.tip_mm[0] - end.target_mm[0], end.tip_mm[1] - end.target_mm[1],
                                    end.tip_mm[2] - end.target_mm[2]);
  EXPECT_LT(miss_mm, 2.5);
  ASSERT_EQ(end.punctures_mm.size(), 2u);
  EXPECT_EQ(loop_.biopsy().findings().membranes, 2u);
  for (std::size_t membrane = 0; membrane < 2; ++membrane) {
    EXPECT_NEAR(loop_.biopsy().findings().found_mm[membrane], end.punctures_mm[membrane], 0.5) << membrane;
  }
  EXPECT_GE(loop_.biopsy().now().images, 5u);
  EXPECT_EQ(loop_.biopsy().now().images_refused, 0u);
  EXPECT_EQ(loop_.refusals(), 0u);
  EXPECT_LE(loop_.most_requests_in_a_tick(), ILK_REQUESTS_PER_TICK);
}

TEST_F(BiopsyModeTest, TheHandPushesNoDeeperThanItsTarget) {
  begin();
  press_hand(20.0);
  const double counts_per_mm = prostate().at_slot(needle_push)->counts_per_unit;
  double deepest_mm = 0.0;
  for (std::uint32_t i = 0; i < minute_ticks && loop_.biopsy().is_open(); ++i) {
    loop_.tick();
    pass_images();
    deepest_mm = std::max(deepest_mm, loop_.state().axis[needle_push].setpoint_counts / counts_per_mm);
  }
  EXPECT_EQ(order().phase, TaskPhase::done);
  const Eigen::Vector3d target_mm(truth().target_mm.data());
  EXPECT_GT(deepest_mm, target_mm.z() - 2.5);
  EXPECT_LT(deepest_mm, biopsy().entry_mm + target_mm.norm());
}

TEST_F(BiopsyModeTest, APunctureIsCuedByATremblingNeedle) {
  begin();
  press_hand(3.0);
  bool cued = false;
  double backward_mm = 0.0;
  double highest = 0.0;
  for (std::uint32_t i = 0; i < minute_ticks && truth().depth_mm < 32.0; ++i) {
    loop_.tick();
    if (loop_.biopsy().now().cue) {
      cued = true;
      const double at = loop_.true_position(needle_push) / prostate().at_slot(needle_push)->counts_per_unit;
      highest = std::max(highest, at);
      backward_mm = std::max(backward_mm, highest - at);
    }
  }
  EXPECT_TRUE(cued);
  EXPECT_GT(backward_mm, 0.05) << "the hand must feel it";
  EXPECT_LT(backward_mm, 0.5);
}

/** Found from outside: the sways of a cue went on and led deeper. */
TEST_F(BiopsyModeTest, ANeedleThatHasToStandDoesNotSway) {
  begin();
  press_hand(5.0);
  for (std::uint32_t i = 0; i < minute_ticks && !loop_.biopsy().now().cue; ++i) {
    loop_.tick();
  }
  ASSERT_TRUE(loop_.biopsy().now().cue);
  loop_.hold({.insertion = true});
  loop_.run(60);  // in which it comes to a stand from its speed
  const std::int32_t held = loop_.state().axis[needle_push].position_counts;
  for (std::uint32_t i = 0; i < 600; ++i) {
    loop_.tick();
    ASSERT_NEAR(loop_.state().axis[needle_push].position_counts, held, 60) << i;
  }
  loop_.hold({});
  loop_.run(500);
  EXPECT_GT(loop_.state().axis[needle_push].position_counts, held + 100);
  EXPECT_TRUE(loop_.biopsy().is_open());
}

TEST_F(BiopsyModeTest, WhereImagesContradictWhatIsBelievedTheInsertionWaitsUntilTheyAgreeAndTheHandLetGo) {
  begin();
  loop_.run(50);
  press_hand(3.0);
  loop_.run(1000);
  const auto depth = [&] { return loop_.state().axis[needle_push].position_counts; };
  const auto moves = [&] {
    const std::int32_t before = depth();
    loop_.run(500);
    return depth() - before > 100;
  };
  show_tip_beside(0.3);
  show_tip_beside(-0.4);
  EXPECT_FALSE(loop_.biopsy().now().images_disagree);
  ASSERT_TRUE(moves());

  for (const double beside_mm : {20.0, -20.0}) {  // far beyond what the estimator takes
    show_tip_beside(beside_mm);
  }
  EXPECT_TRUE(loop_.biopsy().now().images_disagree);
  EXPECT_EQ(loop_.biopsy().now().images_refused, 2u);
  loop_.run(100);
  EXPECT_FALSE(moves());
  EXPECT_TRUE(loop_.biopsy().is_open());

  for (std::size_t n = 0; n < InnovationWatch::agreeing; ++n) {
    show_tip_beside(0.1);
  }
  EXPECT_FALSE(loop_.biopsy().now().images_disagree);
  EXPECT_TRUE(loop_.biopsy().now().waits_for_hand);
  EXPECT_FALSE(moves());
  press_hand(0.0);
  loop_.run(50);
  press_hand(3.0);
  loop_.run(100);
  EXPECT_TRUE(moves());
}

TEST_F(BiopsyModeTest, AnImageThatCannotBeIsCountedAndChangesNothing) {
  begin();
  press_hand(5.0);
  loop_.run(1000);
  SeenImage image{1, {}};
  image.image.time_s = std::nan("");
  loop_.show(image);
  EXPECT_EQ(loop_.biopsy().now().images_refused, 1u);
  loop_.run(10);
  EXPECT_EQ(order().phase, TaskPhase::executing);
}

TEST_F(BiopsyModeTest, AnImageOfNowIsTakenInMotionAndAtRest) {
  begin();
  press_hand(5.0);
  const auto show_now = [&] {
    const Eigen::Vector3d tip = run_->compensator.tip().guide_from_tip.translation();
    loop_.show({1, {(loop_.seen_tick() - run_->start_tick) * tick_s, tip, std::nullopt}});
  };
  for (std::uint32_t taken = 1; taken <= 7; ++taken) {
    loop_.run(501);
    show_now();
    EXPECT_EQ(loop_.biopsy().now().images, taken);
  }
  loop_.pedal(false);
  ASSERT_EQ(order().phase, TaskPhase::paused);
  loop_.run(2000);
  const std::uint32_t now = loop_.seen_tick() - run_->start_tick;
  loop_.show(
      {1, {(now - 1000) * tick_s, run_->compensator.tip().guide_from_tip.translation(), std::nullopt}});
  EXPECT_EQ(loop_.biopsy().now().images, 8u) << "of a second ago, when it rested";
  EXPECT_EQ(loop_.biopsy().now().images_refused, 0u);
}

TEST_F(BiopsyModeTest, ANumberThatSteeringCannotUseEndsItAndIsNamed) {
  begin();
  run_->hand_law.gain_mm_s_n = std::nan("");
  press_hand(5.0);
  loop_.run(50);
  EXPECT_EQ(order().phase, TaskPhase::aborted);
  EXPECT_EQ(order().reason, TaskReason::steering_failed);
  EXPECT_EQ(loop_.biopsy().findings().quantity, "gain_mm_s_n");
  EXPECT_EQ(push_drive(), 0u);
}

TEST_F(BiopsyModeTest, AJammedNeedleEndsIt) {
  begin();
  press_hand(5.0);
  loop_.run(1000);
  loop_.happen(plant::command::JamAxis{needle_push, true});
  loop_.run(1000);
  EXPECT_EQ(order().phase, TaskPhase::aborted);
  EXPECT_EQ(order().reason, TaskReason::off_path);
  EXPECT_EQ(push_drive(), 0u);
}

TEST_F(BiopsyModeTest, ATickAllocatesNothing) {
  begin();
  press_hand(5.0);
  loop_.run(1000);
  BiopsyMode mode{RobotPlan(prostate(), loop_.config())};
  mode.take(test::task_of(1, BiopsyTask{run_}), loop_.state().system.tick);
  ilk_snapshot_t snapshot{};
  snapshot.state = loop_.state();
  test::count_allocations_of(pthread_self());
  for (std::uint32_t i = 0; i < 50; ++i) {
    ++snapshot.state.system.tick;
    snapshot.inputs.frame[force_card][10] += 1000;
    KernelRequests requests;
    mode.tick(snapshot, requests);
  }
  const std::uint32_t allocated = test::counted_allocations();
  test::count_allocations_of();
  EXPECT_EQ(mode.status().phase, TaskPhase::executing);
  EXPECT_EQ(allocated, 0u);
}

TEST(BiopsyMode, ARobotWithoutANeedleTakesNone) {
  BiopsyMode mode{RobotPlan(test::neuro(), test::neuro_config())};
  Biopsy described = *prostate().biopsy;
  auto made = make_biopsy_run(described, tick_s, {0, 0.0, 0.0, {0.0, 0.0, 50.0}, {}},
                              calibration(described.hand), calibration(described.needle));
  ASSERT_TRUE(made);
  mode.take(test::task_of(1, BiopsyTask{std::make_shared<BiopsyRun>(std::move(*made))}), 5);
  EXPECT_EQ(mode.status().phase, TaskPhase::aborted);
}

TEST(ForceWatch, AStandingCardClockIsNoNewReading) {
  ForceWatch watch({force_card, 2, 3});
  ilk_snapshot_t snapshot{};
  const auto look = [&](std::uint32_t tick, bool valid, std::uint32_t time_us) {
    snapshot.state.system.tick = tick;
    snapshot.state.axis[force_card].card_valid = valid ? 1 : 0;
    snapshot.inputs.frame[force_card][10] = time_us;
    watch.look(snapshot);
    return watch.readings().age_ticks(tick);
  };
  snapshot.inputs.frame[force_card][7] = 1970;
  snapshot.inputs.frame[force_card][8] = 1780u << 16;
  EXPECT_GT(look(1, false, 0), minute_ticks);
  EXPECT_EQ(look(2, true, 5), 0u);
  EXPECT_EQ(watch.readings().hand, 1970u);
  EXPECT_EQ(watch.readings().needle, 1780u);
  EXPECT_EQ(look(3, false, 6), 1u);
  EXPECT_EQ(look(4, true, 5), 2u);
  EXPECT_EQ(look(5, true, 6), 0u);
}

}  // namespace
}  // namespace interlock
