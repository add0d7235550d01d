#include "proposals/profile.hpp"

#include <gmock/gmock.h>

#include "motion/axis_move.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_registry.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::neuro_config;
using testing::Each;
using testing::Ge;
using testing::Le;

constexpr std::uint32_t head_slot = 7;
constexpr std::uint32_t lateral_slot = 4;

class ProfileTest : public testing::Test {
 protected:
  Proposal path_of(std::vector<PathLeg> legs) {
    const auto made = registry_.propose(
        {test::along({std::move(legs)}), "edna", RobotMode::coordinated, TaskSource::file}, view_);
    EXPECT_TRUE(made) << made.error().detail;
    return *made;
  }

  Proposal move_to(std::uint32_t slot, std::int32_t counts,
                   std::optional<std::uint32_t> drive = std::nullopt) {
    (void)registry_.propose({MoveTask{slot, counts, drive}, "edna"}, view_);
    return registry_.newest_first().front();
  }

  [[nodiscard]] Profile profile(const Proposal& proposal) const {
    return profile_of(neuro(), neuro_config(), proposal);
  }

  ilk_axis_t& axis(std::uint32_t slot) { return view_.snapshot.state.axis[slot]; }

  ControlView view_ = test::ready_view();
  MotionRegistry registry_{neuro(), neuro_config(), [](const Command&) { return true; },
                           [] { return UtcTime{}; }};
};

TEST_F(ProfileTest, APathBeginsWhereTheAxesWereEndsAtItsTargetsAndKeepsToTheRates) {
  const std::int32_t yaw_from = axis(test::yaw).position_counts;
  const Proposal proposal = path_of({MoveLeg{{{test::yaw, -300}, {head_slot, -1000}}, 0.0, 0.0}});
  axis(test::yaw).position_counts = 0;  // what comes later changes nothing
  const Profile found = profile(proposal);
  ASSERT_EQ(found.basis, ProfileBasis::time) << found.why;
  ASSERT_EQ(found.axes.size(), 2u);
  const AxisProfile& yaw = found.axes[0];
  EXPECT_EQ(yaw.slot, test::yaw);
  EXPECT_EQ(yaw.positions.front(), yaw_from);
  EXPECT_NEAR(yaw.positions.back(), -300.0, 1e-6);
  EXPECT_NEAR(found.axes[1].positions.back(), -1000.0, 1e-6);
  EXPECT_EQ(yaw.velocities.front(), 0.0);
  EXPECT_NEAR(yaw.velocities.back(), 0.0, 1e-6);
  EXPECT_NEAR(found.times_s.back(), proposal.duration_s, 1e-6);
  for (const AxisProfile& each : found.axes) {
    EXPECT_EQ(each.positions.size(), found.times_s.size());
    EXPECT_LE(each.fastest, *each.top_velocity * (1.0 + 1e-9));
    EXPECT_THAT(each.positions, Each(Ge(each.lowest)));
    EXPECT_THAT(each.positions, Each(Le(each.highest)));
  }
  const double fastest_share =
      std::max(yaw.fastest / *yaw.top_velocity, found.axes[1].fastest / *found.axes[1].top_velocity);
  EXPECT_NEAR(fastest_share, 1.0, 1e-3) << "the slowest axis goes as fast as it may";
}

TEST_F(ProfileTest, SamplesAreBoundedHoweverLongAndManyPartedThePathIs) {
  std::vector<PathLeg> legs;
  for (std::int32_t leg = 0; leg < 100; ++leg) {
    legs.emplace_back(MoveLeg{{{test::yaw, leg % 2 == 0 ? -300 : -500}}, 20.0, 1.0});
  }
  const Profile found = profile(path_of(std::move(legs)));
  EXPECT_LE(found.times_s.size(), Profile::most_samples);
  EXPECT_GE(found.times_s.size(), Profile::most_samples * 9 / 10);
  EXPECT_TRUE(std::ranges::is_sorted(found.times_s));
  EXPECT_NEAR(found.times_s.back(), 100 * 21.0, 1.0);
}

TEST_F(ProfileTest, ATrajectoryIsApproachedAndFollowedToItsLastRow) {
  const auto rows = read_trajectory("time [s],yaw [rad]\n0,-0.5\n2,-0.7\n4,-0.2\n", neuro());
  const Proposal proposal = path_of({TimedLeg{rows.value()}});
  const Profile found = profile(proposal);
  const Axis& yaw = *neuro().at_slot(test::yaw);
  EXPECT_NEAR(found.axes[0].positions.back(), -0.2 * yaw.counts_per_unit, 1.0);
  EXPECT_NEAR(found.axes[0].lowest, std::min<double>(-0.7 * yaw.counts_per_unit, found.axes[0].positions[0]),
              1.0);
  // The check plans to the nearest count of the first row, the walk to the row itself.
  EXPECT_NEAR(found.times_s.back(), proposal.duration_s, 1e-3);
}

TEST_F(ProfileTest, AMoveOfOneAxisHasTheDriveOfItsLawOverTheWay) {
  const std::int32_t from = axis(lateral_slot).position_counts;
  const Proposal proposal = move_to(lateral_slot, from + 400, 20'000);
  const Profile found = profile(proposal);
  ASSERT_EQ(found.basis, ProfileBasis::way) << found.why;
  const AxisProfile& moved = found.axes.front();
  EXPECT_EQ(moved.positions.front(), from);
  EXPECT_EQ(moved.positions.back(), from + 400);
  EXPECT_EQ(moved.drives.back(), 0u);
  EXPECT_THAT(moved.drives, Each(Le(20'000u)));
  const RobotPlan plan(neuro(), neuro_config());
  const DriveLaw law = AxisMove::law_of(plan.axis[lateral_slot], axis(lateral_slot), 20'000);
  EXPECT_EQ(moved.drives.front(), law.at(400));
  EXPECT_TRUE(found.times_s.empty());
}

TEST_F(ProfileTest, AnAxisThatIsNotHomedHasTheTravelOfAPressForItsRange) {
  axis(test::yaw).homed = 0;
  const Proposal refused = move_to(test::yaw, axis(test::yaw).position_counts + 5000);
  EXPECT_EQ(refused.state, ProposalState::refused);
  const Profile found = profile(refused);
  ASSERT_EQ(found.basis, ProfileBasis::way) << "what was refused is seen, too";
  EXPECT_FALSE(found.axes.front().homed);
  EXPECT_LT(found.axes.front().allowed.highest_counts, found.axes.front().positions.back());
  EXPECT_LE(found.axes.front().most_drive, neuro().at_slot(test::yaw)->drive.unhomed_max);
}

TEST_F(ProfileTest, HomingAndWhatWasNeverCheckedHaveNone) {
  ASSERT_TRUE(registry_.propose({*home_all(neuro()), "edna", RobotMode::home}, view_));
  const Profile homing = profile(registry_.newest_first().front());
  EXPECT_EQ(homing.basis, ProfileBasis::none);
  EXPECT_FALSE(homing.why.empty());
  Proposal unchecked;
  EXPECT_EQ(profile(unchecked).basis, ProfileBasis::none);
}

class CheckListTest : public ProfileTest {
 protected:
  static std::string words(const Proposal& proposal) {
    std::string text;
    for (const CheckResult& check : proposal.checks) {
      text += std::string(check_name(check.name)) + ":" + std::string(outcome_name(check.outcome)) +
              (check.code.empty() ? " " : "=" + check.code + " ");
    }
    return text;
  }
};

TEST_F(CheckListTest, TheCheckThatFailsIsNamedThoseBeforePassedAndThoseAfterAreNotReached) {
  EXPECT_EQ(
      words(move_to(lateral_slot, 5000)),
      "other_motion:passed configuration:passed mode:passed axes:passed drive:passed range:failed=RANGE ");
  axis(lateral_slot).state = ILK_AXIS_FAULTED;
  EXPECT_EQ(words(move_to(lateral_slot, -500)),
            "other_motion:passed configuration:passed mode:passed axes:failed=FAULTED drive:not_reached "
            "range:not_reached ");
}

TEST_F(CheckListTest, APathThatPassesHasPassedEachOfItsChecks) {
  const Proposal proposal = path_of({MoveLeg{{{test::yaw, -300}}, 0.0, 0.0}});
  EXPECT_EQ(words(proposal),
            "configuration:passed mode:passed axes:passed homed:passed range:passed separation:passed "
            "rates:passed ");
}

TEST_F(CheckListTest, ApprovingMakesTheChecksAnew) {
  Proposal proposal = path_of({MoveLeg{{{test::yaw, -300}}, 0.0, 0.0}});
  ASSERT_EQ(proposal.state, ProposalState::checked);
  axis(test::yaw).homed = 0;
  ++view_.snapshot.state.system.tick;
  EXPECT_FALSE(registry_.approve(proposal.id, view_));
  EXPECT_THAT(words(*registry_.find(proposal.id)),
              testing::HasSubstr("homed:failed=NOT_HOMED range:not_reached"));
  EXPECT_EQ(registry_.find(proposal.id)->checked_against->state.system.tick,
            view_.snapshot.state.system.tick);
}

TEST_F(CheckListTest, ARejectedProposalIsEndedByNameAndCannotBeApproved) {
  const Proposal proposal = path_of({MoveLeg{{{test::yaw, -300}}, 0.0, 0.0}});
  const auto rejected = registry_.reject(proposal.id, "ann");
  ASSERT_TRUE(rejected);
  EXPECT_EQ(rejected->state, ProposalState::aborted);
  EXPECT_EQ(rejected->detail, "Rejected by ann before it was approved.");
  EXPECT_EQ(registry_.approve(proposal.id, view_).error().code, "NOT_WAITING");
  EXPECT_EQ(registry_.reject(proposal.id, "ann").error().code, "NOT_WAITING");
  const Proposal approved = move_to(lateral_slot, -500);
  EXPECT_EQ(registry_.reject(approved.id, "ann").error().code, "NOT_WAITING")
      << "what is approved is aborted";
}

}  // namespace
}  // namespace interlock
