/** @file A family is its folder and nothing else: one that only the tests have is read, solved and drawn. */
#include "kinematics/family.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "kinematics/workspace.hpp"
#include "robot/robot_file.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

std::span<const KinematicsFamily> families_of_the_tests();

namespace {

using testing::ElementsAre;

std::vector<std::string_view> names_of(std::span<const KinematicsFamily> families) {
  std::vector<std::string_view> names;
  for (const KinematicsFamily& family : families) {
    names.push_back(family.first);
  }
  return names;
}

/** The test bench of one axis, put on the family's arm. */
std::string polar_file() {
  std::ifstream file(INTERLOCK_TEST_ROBOTS "/bench.toml");
  std::ostringstream text;
  text << file.rdbuf() << "[kinematics]\nfamily = \"polar\"\nheight_mm = 20.0\n"
       << "[probe]\ntreatment_to_tip_mm = 0.0\nrobot_to_entry_mm = 0.0\n"
       << "cannula_to_treatment_mm = 0.0\ntreatment_to_robot_at_home_mm = 0.0\n"
       << "[targeting]\ntolerance_mm = 1.0\ntolerance_deg = 1.0\n"
       << "[targeting.registration]\norigin_mm = [0, 0, 0]\norigin_tolerance_mm = [9, 9, 9]\n"
       << "rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nrotation_tolerance_deg = 9.0\n";
  return text.str();
}

TEST(Family, is_known_by_its_folder) {
  EXPECT_THAT(names_of(kinematics_families()),
              ElementsAre("neuro_rcm", "prostate_trapezoids", "serial_chain"));
  EXPECT_THAT(names_of(families_of_the_tests()), ElementsAre("polar"));
}

TEST(Family, of_another_folder_is_read_by_its_own_reader) {
  const auto unknown = parse_robot(polar_file(), "polar.toml");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().key, "kinematics.family");
  EXPECT_EQ(unknown.error().expected, R"(one of "neuro_rcm", "prostate_trapezoids", "serial_chain")");
  const auto unplayed = parse_robot(polar_file(), "polar.toml", families_of_the_tests());
  ASSERT_FALSE(unplayed);
  EXPECT_EQ(unplayed.error().problem, "no axis plays \"turn\"") << "the bench has one axis, the family two";
}

TEST(Family, has_all_parts_through_the_interface) {
  KinematicsPtr polar;
  {
    const toml::table root = toml::parse("height_mm = 20.0");
    ReadLog log;
    TableReader table(log, root, "kinematics");
    polar = families_of_the_tests().front().second(table);
    ASSERT_FALSE(log.first_error);
  }
  const auto positions = polar->positions_for({1.0, 2.0, 20.0}, {30.0, 40.0, 20.0}, 0.0);
  ASSERT_TRUE(positions);
  EXPECT_DOUBLE_EQ((*positions)[1], 50.0);
  EXPECT_LE((polar->zframe_from_treatment(*positions)->translation() - Eigen::Vector3d(30, 40, 20)).norm(),
            1e-9);
  EXPECT_EQ(polar->zframe_body(*positions)->back().name, "probe");
  EXPECT_EQ(polar->calibrated().front().key, "height_mm");
  const std::vector<double> lowest{-1.0, 10.0};
  const std::vector<double> highest{1.0, 60.0};
  EXPECT_EQ(sample_workspace(*polar, lowest, highest, 100, 1)->zframe_mm.size(), 100U);
}

}  // namespace
}  // namespace interlock
