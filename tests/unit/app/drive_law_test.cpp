#include "motion/drive_law.hpp"

#include <gtest/gtest.h>

#include "robot_fixture.hpp"

namespace interlock {
namespace {

const ilk_axis_config_t& rules() { return test::neuro_config().axis[test::insertion]; }

DriveBounds bounds(std::uint32_t min, std::uint32_t dead_zone = 0) {
  return {.max = rules().max_drive, .min = min, .dead_zone = dead_zone};
}

TEST(DriveLaw, DrivesAtItsCeilingFarFromTheSetpoint) {
  EXPECT_EQ(drive_law(rules(), bounds(0), rules().max_drive).at(1000), rules().max_drive);
}

TEST(DriveLaw, NeverExceedsTheCeilingOfTheMove) {
  const DriveLaw law = drive_law(rules(), bounds(0), 5000);
  for (std::uint64_t distance = 0; distance < 2000; ++distance) {
    EXPECT_LE(law.at(distance), 5000u);
  }
}

TEST(DriveLaw, NeverExceedsTheAxisBoundWhateverTheMoveAsksFor) {
  EXPECT_EQ(drive_law(rules(), bounds(0), UINT32_MAX).at(UINT32_MAX), rules().max_drive);
}

TEST(DriveLaw, SlowsDownAsTheSetpointComesNear) {
  const DriveLaw law = drive_law(rules(), bounds(0), rules().max_drive);
  for (std::uint64_t distance = 0; distance < 100; ++distance) {
    EXPECT_LE(law.at(distance), law.at(distance + 1));
  }
  EXPECT_LT(law.at(2), rules().max_drive / 10);
}

TEST(DriveLaw, StillMovesTheAxisNextToTheSetpoint) {
  constexpr std::uint32_t dead_zone_fraction = 50;
  EXPECT_GT(drive_law(rules(), bounds(0), rules().max_drive).at(1), rules().max_drive / dead_zone_fraction);
}

TEST(DriveLaw, TakesTheSmallestDriveOfTheRobotFile) {
  EXPECT_EQ(drive_law(rules(), bounds(4095), rules().max_drive).at(1), 4095u);
}

TEST(DriveLaw, BeginsBehindTheDeadZone) {
  const std::uint32_t dead_zone = rules().max_drive * 3 / 20;
  const DriveLaw law = drive_law(rules(), bounds(0, dead_zone), rules().max_drive);
  EXPECT_GT(law.at(1), dead_zone);
  EXPECT_GT(law.at(10), dead_zone + rules().max_drive / 10);
  EXPECT_EQ(law.at(1000), rules().max_drive);
}

TEST(DriveLaw, HoldsForTheLargestDriveAndDistance) {
  ilk_axis_config_t largest = rules();
  largest.max_drive = 0x7FFFFFFF;
  largest.coast_counts = 1u << 20u;
  EXPECT_EQ(drive_law(largest, {.max = largest.max_drive}, largest.max_drive).at(UINT64_MAX),
            largest.max_drive);
}

}  // namespace
}  // namespace interlock
