#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "proposals/checks.hpp"
#include "proposals/motion_registry.hpp"
#include "proposals/proposal_json.hpp"
#include "robot_fixture.hpp"
#include "service/drafts.hpp"
#include "tasks.hpp"

namespace interlock {
namespace {

using nlohmann::json;
using test::prostate;
using testing::HasSubstr;

constexpr std::uint32_t turned_axis = 0;

SweepTask draft_of(double from_hz, double to_hz, double step_hz = 100.0) {
  return {turned_axis, *frequency_steps(from_hz, to_hz, step_hz, 1000)};
}

std::string code_of(const tl::expected<void, Refusal>& checked) {
  return checked ? "allowed" : checked.error().code;
}

tl::expected<void, Refusal> checked(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                                    const SweepTask& draft) {
  CheckList checks;
  check_sweep(robot, config, view, draft, checks);
  return checks.outcome();
}

class SweepProposalTest : public testing::Test {
 protected:
  void expect_refused(const SweepTask& draft, const std::string& code) {
    const auto proposal = propose(draft);
    ASSERT_FALSE(proposal);
    EXPECT_EQ(proposal.error().code, code) << proposal.error().detail;
    EXPECT_FALSE(proposal.error().next_step.empty());
    EXPECT_THAT(sent_, testing::IsEmpty());
  }

  tl::expected<Proposal, Refusal> propose(const SweepTask& sweep) {
    return test::approved(registry_, {sweep, "edna", RobotMode{"frequency_sweep"}}, view_);
  }

  void report(TaskPhase phase, std::uint32_t step) {
    view_.tasks.of<SweepTask>() = {1, phase, TaskReason::swept, 0, 0, turned_axis, step};
    registry_.follow(view_);
  }

  const ilk_config_t config_ = test::config_of(prostate());
  ControlView view_ = test::ready_view(prostate());
  UtcTime now_{std::chrono::milliseconds(1714566896789)};
  std::vector<Command> sent_;
  MotionRegistry registry_{prostate(), config_,
                           [this](const Command& command) {
                             sent_.push_back(command);
                             return true;
                           },
                           [this] { return now_; }};
};

TEST_F(SweepProposalTest, TheBandIsThatOfThePublishedStartAndMaximumVelocity) {
  const auto band = frequency_band(*prostate().at_slot(turned_axis));
  ASSERT_TRUE(band);
  EXPECT_NEAR(band->highest_hz, 0x45A0DB84 / 22009.0, 0.001);
  EXPECT_NEAR(band->lowest_hz, 0x42B8DBB4 / 22009.0, 0.001);
  EXPECT_FALSE(frequency_band(*prostate().find("insertion")));
}

TEST_F(SweepProposalTest, ASweepWithinTheBandIsApprovedAndOrdered) {
  const auto proposal = propose(draft_of(53000, 51000));
  ASSERT_TRUE(proposal) << proposal.error().detail;
  EXPECT_EQ(proposal->state, ProposalState::approved);
  const auto& order = std::get<Approval>(sent_.front()).task->work.as<SweepTask>();
  EXPECT_EQ(order.slot, turned_axis);
  EXPECT_EQ(order.steps.count, 21u);
  EXPECT_EQ(order.steps.word(20), 22009u * 51000u);
  EXPECT_EQ(registry_.app_mode(), "frequency_sweep");
  report(TaskPhase::executing, 4);
  EXPECT_THAT(registry_.find(1)->detail, HasSubstr("52600.0 Hz, frequency 5 of 21"));
  report(TaskPhase::done, 21);
  EXPECT_EQ(registry_.app_mode(), "manual");
}

TEST_F(SweepProposalTest, BothEndsOfTheBandAreAllowedAndAWordBeyondIsNot) {
  const FrequencyBand band = *frequency_band(*prostate().at_slot(turned_axis));
  const SweepTask whole = draft_of(band.highest_hz, band.lowest_hz, band.highest_hz - band.lowest_hz);
  EXPECT_TRUE(checked(prostate(), config_, view_, whole));
  SweepTask beyond = whole;
  ++beyond.steps.first_word;
  EXPECT_EQ(code_of(checked(prostate(), config_, view_, beyond)), "DRIVE");
  beyond.steps.first_word -= 2;
  EXPECT_EQ(code_of(checked(prostate(), config_, view_, beyond)), "DRIVE") << "faster than allowed";
}

TEST_F(SweepProposalTest, ThePublishedRangeIsRefusedAndBothRangesAreNamed) {
  const SweepTask published =
      draft_of(published_sweep.highest_hz, published_sweep.lowest_hz, published_sweep_step_hz);
  EXPECT_EQ(published.steps.first_word, 0x48000000u);
  const auto proposal = propose(published);
  ASSERT_FALSE(proposal);
  EXPECT_EQ(proposal.error().code, "DRIVE");
  EXPECT_THAT(proposal.error().expected, HasSubstr("50861.5 to 53076.9 Hz"));
  EXPECT_THAT(proposal.error().expected, HasSubstr("48786.5 to 54884.8 Hz"));
  EXPECT_THAT(sent_, testing::IsEmpty());
  EXPECT_EQ(registry_.find(1)->state, ProposalState::refused);
}

TEST_F(SweepProposalTest, AnAxisThatCannotBeMovedIsRefusedWithItsReason) {
  ilk_axis_t& axis = view_.snapshot.state.axis[turned_axis];
  axis.homed = 0;
  expect_refused(draft_of(53000, 51000), "NOT_HOMED");
  axis.homed = 1;
  axis.state = ILK_AXIS_DISABLED;
  expect_refused(draft_of(53000, 51000), "DISABLED");
  view_.snapshot.state.system.mode = ILK_MODE_LOCKED;
  expect_refused(draft_of(53000, 51000), "MODE");
}

TEST_F(SweepProposalTest, AMoveIsRefusedWhileASweepIsOpen) {
  ASSERT_TRUE(propose(draft_of(53000, 51000)));
  const auto move = registry_.propose({MoveTask{turned_axis, 100}, "edna"}, view_);
  ASSERT_FALSE(move);
  EXPECT_EQ(move.error().code, "MODE_PATH");
}

TEST_F(SweepProposalTest, MeasuredSpeedsAreShownWithTheirFrequencies) {
  ASSERT_TRUE(propose(draft_of(52000, 51900)));
  view_.sweep_speeds[0] = 250.0F;
  report(TaskPhase::executing, 1);
  const json shown = to_json(*registry_.find(1));
  EXPECT_EQ(shown["mode"], "frequency_sweep");
  EXPECT_EQ(shown["frequencies"][0], json({{"hz", 52000.0}, {"counts_per_s", 250.0}}));
  EXPECT_EQ(shown["frequencies"][1], json({{"hz", 51900.0}, {"counts_per_s", nullptr}}));
}

TEST(FrequencySteps, ThatNobodyCouldHoldAreNone) {
  EXPECT_FALSE(frequency_steps(53000, 51000, 0.0, 1));
  EXPECT_FALSE(frequency_steps(53000, 51000, -1.0, 1));
  EXPECT_FALSE(frequency_steps(53000, 51000, 10.0, 1)) << "201 frequencies";
  EXPECT_FALSE(frequency_steps(1e9, 51000, 1e6, 1));
  EXPECT_TRUE(frequency_steps(52990, 51000, 10.0, 1)) << "200 frequencies";
}

TEST(SweepDrafts, NameTheFieldThatIsWrong) {
  const json good{{"kind", "sweep"}, {"axis", "rotation"}, {"from_hz", 53000},
                  {"to_hz", 51000},  {"step_hz", 100},     {"dwell_s", 0.5}};
  const auto draft = sweep_draft(prostate(), good, "edna");
  ASSERT_TRUE(draft);
  EXPECT_EQ(draft->work.as<SweepTask>().steps.dwell_ticks, 500u);
  const std::pair<const char*, json> cases[] = {
      {"axis", "insertion"}, {"axis", "elbow"}, {"from_hz", "low"}, {"step_hz", 1}, {"dwell_s", 0}};
  for (const auto& [field, value] : cases) {
    json bad = good;
    bad[field] = value;
    const auto refused = sweep_draft(prostate(), bad, "edna");
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().field, field) << bad;
  }
  EXPECT_EQ(sweep_draft(test::neuro(), good, "edna").error().code, "NOT_FOUND");
}

TEST(SweepDrafts, AnEndOfTheBandIsTakenAsItIsShown) {
  const ilk_config_t config = test::config_of(prostate());
  const auto code_from = [&](double from_hz) {
    const json body{{"kind", "sweep"},  {"axis", "rotation"}, {"from_hz", from_hz},
                    {"to_hz", 53076.9}, {"step_hz", 100},     {"dwell_s", 0.5}};
    const auto draft = sweep_draft(prostate(), body, "edna");
    EXPECT_TRUE(draft);
    const auto passed =
        checked(prostate(), config, test::ready_view(prostate()), draft->work.as<SweepTask>());
    return passed ? std::string("passes") : passed.error().code;
  };
  EXPECT_EQ(code_from(50861.5), "passes");
  EXPECT_EQ(code_from(50861.4), "DRIVE") << "that is another frequency";
}

TEST(SweepDrafts, TheWholeBandIsSweptInPublishedSteps) {
  const auto draft = whole_sweep_draft(prostate(), "edna");
  ASSERT_TRUE(draft);
  EXPECT_EQ(draft->work.as<SweepTask>().steps.step_words, -1000000);
  EXPECT_EQ(draft->work.as<SweepTask>().steps.count, 49u);
  EXPECT_EQ(draft->work.as<SweepTask>().steps.dwell_ticks, 1000u);
  EXPECT_TRUE(checked(prostate(), test::config_of(prostate()), test::ready_view(prostate()),
                      draft->work.as<SweepTask>()));
}

}  // namespace
}  // namespace interlock
