#include "service/positions_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "robot_fixture.hpp"

namespace interlock::web {
namespace {

using nlohmann::json;
using test::insertion;
using test::neuro;
using test::neuro_config;
using testing::HasSubstr;

const UtcTime noon{std::chrono::seconds(1'714'564'800)};

json saved_file() {
  OpenTargets targets{};
  targets[insertion] = {true, 1234};
  return positions_file(neuro(), test::ready_view(), targets, noon);
}

tl::expected<SavedPositions, Problem> read(const json& file) {
  return read_positions(file, neuro(), neuro_config(), "");
}

/** The problem of the saved file after that change. */
Problem problem_of(const std::function<void(json&)>& change) {
  json file = saved_file();
  change(file);
  const auto positions = read(file);
  EXPECT_FALSE(positions) << file;
  return positions ? Problem{} : positions.error();
}

TEST(PositionsFile, NamesRobotConfigurationTimeAndEveryAxis) {
  const json file = saved_file();
  EXPECT_EQ(file["format"], "interlock-positions");
  EXPECT_EQ(file["version"], 1);
  EXPECT_EQ(file["robot"], "neuro");
  EXPECT_EQ(file["saved"], "2024-05-01T12:00:00.000Z");
  ASSERT_EQ(file["axes"].size(), neuro().axes.size());
  for (std::size_t i = 0; i < neuro().axes.size(); ++i) {
    EXPECT_EQ(file["axes"][i]["axis"], neuro().axes[i].name);
    EXPECT_EQ(file["axes"][i]["enabled"], true);
    EXPECT_EQ(file["axes"][i]["homed"], true);
    EXPECT_EQ(file["axes"][i]["setpoint_counts"], neuro().axes[i].slot == insertion ? json(1234) : json());
  }
  EXPECT_EQ(positions_file_name(neuro(), noon), "neuro-positions-20240501T120000Z.json");
}

TEST(PositionsFile, NamesTheConfigurationThatTheKernelRuns) {
  ControlView view = test::ready_view();
  view.snapshot.config_crc = 0x00c0ffee;
  EXPECT_EQ(positions_file(neuro(), view, {}, noon)["config_crc"], "00c0ffee");
}

TEST(PositionsFile, IsReadAsItWasSaved) {
  const auto positions = read(json::parse(saved_file().dump()));
  ASSERT_TRUE(positions);
  EXPECT_EQ(positions->saved, noon);
  ASSERT_EQ(positions->axes.size(), neuro().axes.size());
  const ControlView view = test::ready_view();
  for (const SavedAxis& axis : positions->axes) {
    EXPECT_EQ(axis.position_counts, view.snapshot.state.axis[axis.slot].position_counts);
  }
  EXPECT_EQ(positions->at_slot(insertion)->setpoint_counts, 1234);
  EXPECT_EQ(positions->at_slot(9), nullptr);
}

TEST(PositionsFile, ItsAxesComeInTheOrderOfTheRobot) {
  json file = saved_file();
  std::reverse(file["axes"].begin(), file["axes"].end());
  const auto positions = read(file);
  ASSERT_TRUE(positions);
  for (std::size_t i = 0; i < neuro().axes.size(); ++i) {
    EXPECT_EQ(positions->axes[i].slot, neuro().axes[i].slot);
  }
}

TEST(PositionsFile, OfAnotherVersionIsRefusedWhateverElseItHas) {
  const Problem problem = problem_of([](json& file) {
    file["version"] = 2;
    file["novelty"] = true;
  });
  EXPECT_EQ(problem.status, Status::conflict);
  EXPECT_EQ(problem.code, "POSITIONS_VERSION");
  EXPECT_FALSE(problem.next_step.empty());
}

TEST(PositionsFile, OfAnotherRobotIsRefusedWhateverItsAxes) {
  const Problem problem = problem_of([](json& file) {
    file["robot"] = "prostate";
    file["axes"][0]["axis"] = "slider";
  });
  EXPECT_EQ(problem.status, Status::conflict);
  EXPECT_EQ(problem.code, "POSITIONS_ROBOT");
  EXPECT_THAT(problem.detail, HasSubstr("prostate"));
}

TEST(PositionsFile, OfAnotherConfigurationIsRefused) {
  const Problem problem = problem_of([](json& file) { file["config_crc"] = "00c0ffee"; });
  EXPECT_EQ(problem.status, Status::conflict);
  EXPECT_EQ(problem.code, "POSITIONS_CONFIG");
  EXPECT_THAT(problem.detail, HasSubstr("00c0ffee"));
}

TEST(PositionsFile, AWrongFieldIsNamed) {
  const std::pair<std::string, std::function<void(json&)>> cases[] = {
      {"format", [](json& file) { file["format"] = "positions"; }},
      {"format", [](json& file) { file.erase("format"); }},
      {"version", [](json& file) { file.erase("version"); }},
      {"version", [](json& file) { file["version"] = "one"; }},
      {"version", [](json& file) { file["version"] = 0; }},
      {"robot", [](json& file) { file["robot"] = 3; }},
      {"robot", [](json& file) { file.erase("robot"); }},
      {"config_crc", [](json& file) { file["config_crc"] = "xyz"; }},
      {"config_crc", [](json& file) { file["config_crc"] = "00C0FFEE"; }},
      {"saved", [](json& file) { file["saved"] = "yesterday"; }},
      {"saved", [](json& file) { file["saved"] = nullptr; }},
      {"axes", [](json& file) { file["axes"] = json::object(); }},
      {"axes", [](json& file) { file.erase("axes"); }},
      {"axes", [](json& file) { file["axes"].erase(2); }},
      {"note", [](json& file) { file["note"] = "mine"; }},
      {"axes[1]", [](json& file) { file["axes"][1] = 7; }},
      {"axes[1].axis", [](json& file) { file["axes"][1]["axis"] = file["axes"][0]["axis"]; }},
      {"axes[1].axis", [](json& file) { file["axes"][1]["axis"] = "elbow"; }},
      {"axes[1].axis", [](json& file) { file["axes"][1].erase("axis"); }},
      {"axes[1].speed", [](json& file) { file["axes"][1]["speed"] = 1; }},
      {"axes[1].position_counts", [](json& file) { file["axes"][1]["position_counts"] = 2147483648; }},
      {"axes[1].position_counts", [](json& file) { file["axes"][1]["position_counts"] = 1.5; }},
      {"axes[1].position_counts", [](json& file) { file["axes"][1]["position_counts"] = nullptr; }},
      {"axes[1].setpoint_counts", [](json& file) { file["axes"][1]["setpoint_counts"] = true; }},
      {"axes[1].setpoint_counts", [](json& file) { file["axes"][1].erase("setpoint_counts"); }},
      {"axes[1].enabled", [](json& file) { file["axes"][1]["enabled"] = 1; }},
      {"axes[1].homed", [](json& file) { file["axes"][1].erase("homed"); }}};
  for (const auto& [field, change] : cases) {
    const Problem problem = problem_of(change);
    EXPECT_EQ(problem.status, Status::unprocessable_entity) << problem.detail;
    EXPECT_EQ(problem.code, "INVALID");
    EXPECT_EQ(problem.field, field) << problem.detail;
    EXPECT_FALSE(problem.expected.empty()) << problem.detail;
  }
}

TEST(PositionsFile, WhatIsNoObjectIsNoFile) {
  for (const json& file : {json(), json(7), json::array(), json("file")}) {
    EXPECT_FALSE(read(file)) << file;
  }
}

TEST(PositionsFile, AFileInsideOfABodyIsNamedWhole) {
  json file = saved_file();
  file["axes"][1]["homed"] = 3;
  EXPECT_EQ(read_positions(file, neuro(), neuro_config(), "file").error().field, "file.axes[1].homed");
}

TEST(PositionsFile, AnAxisThatItLacksIsNamed) {
  const Problem problem = problem_of([](json& file) { file["axes"].erase(0); });
  EXPECT_THAT(problem.detail, HasSubstr(neuro().axes[0].name));
}

TEST(PositionsComparison, SetsBothPositionsSideBySideAndChangesNothing) {
  json file = saved_file();
  const Axis& axis = *neuro().at_slot(insertion);
  for (json& each : file["axes"]) {
    if (each["axis"] == axis.name) {
      each["position_counts"] = axis.soft_limits.max_counts + 1;
    }
  }
  const ControlView view = test::ready_view();
  const json compared = compare_positions(read(file).value(), neuro(), neuro_config(), view);
  EXPECT_EQ(compared["saved"], "2024-05-01T12:00:00.000Z");
  for (const json& row : compared["axes"]) {
    const bool beyond = row["axis"] == axis.name;
    EXPECT_EQ(row["restorable"], !beyond) << row;
    EXPECT_EQ(row["now_counts"], view.snapshot.state.axis[row["slot"].get<std::size_t>()].position_counts);
    EXPECT_EQ(row["setpoint_counts"], beyond ? json(1234) : json());
  }
}

}  // namespace
}  // namespace interlock::web
