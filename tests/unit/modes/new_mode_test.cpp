/**
 * @file
 * A mode is added by one folder: a program that lists `there_and_back` besides those of the app has it, from
 * the robot's file and the interface to the motion.
 */
#include <fstream>
#include <regex>
#include <sstream>

#include "closed_loop.hpp"
#include "http_fixture.hpp"
#include "robot/robot_file.hpp"
#include "there_and_back/mode.hpp"

namespace interlock::web {
namespace {

using test::insertion;

/** The NeuroRobot, whose file names the mode. */
const Robot& robot() {
  static const Robot loaded = [] {
    std::ifstream file(INTERLOCK_ROBOTS "/neuro.toml");
    std::stringstream text;
    text << file.rdbuf();
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "neuro.toml";
    std::ofstream(path) << std::regex_replace(text.str(), std::regex("modes = \\[[^\\]]*\\]"),
                                              R"(modes = ["manual", "there_and_back"])");
    return load_robot(path).value();
  }();
  return loaded;
}

const ilk_config_t& config() {
  static const ilk_config_t compiled = test::config_of(robot());
  return compiled;
}

class NewModeTest : public HttpTest {
 protected:
  NewModeTest() : HttpTest(robot(), config()) {
    ControlView view = test::ready_view(robot());
    view.snapshot.config_crc = config().crc;
    show(view);
  }
};

TEST_F(NewModeTest, IsOneFolderFromTheRobotsFileToTheMotion) {
  const Answered made = post("/api/proposals", R"({"kind": "there_and_back", "slot": 3, "by_counts": 300})");
  ASSERT_EQ(made.status, 201u) << made.body;
  const json proposal = json::parse(made.body);
  EXPECT_EQ(proposal["kind"], "there_and_back");
  EXPECT_EQ(proposal["mode"], "there_and_back");
  EXPECT_EQ(proposal["axis"], "insertion");
  ASSERT_EQ(post("/api/proposals/1/approve").status, 200u);
  const Task task = next_task();

  test::ClosedLoop loop(11, 2, robot());
  loop.make_ready(insertion);
  ASSERT_EQ(loop.carry_out(1, MoveTask{insertion, 500}, test::minute_ticks).phase, TaskPhase::done);
  const std::int32_t start = loop.state().axis[insertion].position_counts;
  std::int32_t farthest = start;
  loop.watch([&] { farthest = std::max(farthest, loop.state().axis[insertion].position_counts); });
  EXPECT_EQ(loop.carry_out(2, task.work, test::minute_ticks).phase, TaskPhase::done);
  EXPECT_NEAR(farthest, start + 300, 20);
  EXPECT_NEAR(loop.state().axis[insertion].position_counts, start, 3);
}

TEST_F(NewModeTest, IsRefusedAndListedAsTheOthersAre) {
  EXPECT_THAT(json::parse(get("/api/mode").body)["modes"], testing::Contains("there_and_back"));
  EXPECT_EQ(put("/api/mode", R"({"mode": "there_and_back"})").problem()["code"], "NO_TARGETS");
  const Answered unknown = post("/api/proposals", R"({"kind": "somersault"})");
  EXPECT_THAT(unknown.problem()["expected"].get<std::string>(), testing::HasSubstr("there_and_back"));
}

TEST_F(NewModeTest, IsReplacedAsEveryMotionOfTheWholeIs) {
  test::ClosedLoop loop(11, 2, robot());
  loop.make_ready(insertion);
  loop.give(1, ThereAndBackTask{insertion, 300});
  loop.run(100);
  EXPECT_EQ(loop.status(typeid(ThereAndBackTask)).phase, TaskPhase::executing);
  loop.give(2, MoveTask{insertion, 0});
  EXPECT_EQ(loop.move(insertion).reason, TaskReason::superseded) << "a move yields";
  loop.give(3, HomeTask{0, 0, {insertion}});
  EXPECT_EQ(loop.status(typeid(ThereAndBackTask)).reason, TaskReason::axis_homing);
}

}  // namespace
}  // namespace interlock::web
