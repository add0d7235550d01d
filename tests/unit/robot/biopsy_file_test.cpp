#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "neuro.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;

std::string prostate_text() {
  std::ifstream stream(INTERLOCK_ROBOTS "/prostate.toml");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/** One way to break the [biopsy] table: the line that is replaced, by what, and what the error must say. */
struct BrokenBiopsy {
  const char* title;
  const char* from;
  const char* to;
  const char* key;
  const char* problem;
  const char* expected;
};

void PrintTo(const BrokenBiopsy& broken, std::ostream* stream) { *stream << broken.title; }

class BrokenBiopsyTable : public testing::TestWithParam<BrokenBiopsy> {};

TEST_P(BrokenBiopsyTable, IsRefusedWithFileLineKeyAndWhatWasExpected) {
  const BrokenBiopsy& broken = GetParam();
  std::string text = prostate_text();
  const std::size_t begin = text.find(std::string("\n") + broken.from + "\n");
  ASSERT_NE(begin, std::string::npos) << broken.from;
  text.replace(begin + 1, std::string_view(broken.from).size(), broken.to);
  const auto robot = parse_robot(text, "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().file, "broken.toml");
  const std::string_view line = std::string_view(broken.to).empty() ? "[biopsy]" : broken.to;
  EXPECT_EQ(robot.error().line, test::line_of(text, line)) << robot.error().message();
  EXPECT_EQ(robot.error().key, broken.key);
  EXPECT_THAT(robot.error().problem, HasSubstr(broken.problem));
  EXPECT_THAT(robot.error().expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Keys, BrokenBiopsyTable,
    testing::Values(
        BrokenBiopsy{"missing", "entry_mm = 20.0", "", "biopsy.entry_mm", "missing", "a finite number"},
        BrokenBiopsy{"unknown", "entry_mm = 20.0", "depth_mm = 3\nentry_mm = 20.0", "biopsy.depth_mm",
                     "the key is unknown", ""},
        BrokenBiopsy{"hand_of_no_sensor", "hand_force = \"input_force\"", "hand_force = \"thumb\"",
                     "biopsy.hand_force", "no sensor has a channel \"thumb\"", "[[sensor.channel]]"},
        BrokenBiopsy{"needle_of_no_sensor", "needle_force = \"needle_force\"", "needle_force = \"tip\"",
                     "biopsy.needle_force", "no sensor has a channel \"tip\"", "[[sensor.channel]]"},
        BrokenBiopsy{"hand_is_a_number", "hand_force = \"input_force\"", "hand_force = 3",
                     "biopsy.hand_force", "3", "text"},
        BrokenBiopsy{"no_newton", "units_per_newton = 101.97162", "units_per_newton = 0",
                     "biopsy.units_per_newton", "0", "a number from 0.001 to"},
        BrokenBiopsy{"entry_behind_home", "entry_mm = 20.0", "entry_mm = -1.0", "biopsy.entry_mm", "-1",
                     "a number from 0 to 500"},
        BrokenBiopsy{"entry_is_text", "entry_mm = 20.0", "entry_mm = \"20\"", "biopsy.entry_mm", "20",
                     "a finite number"},
        BrokenBiopsy{"deadband_below_zero", "deadband_n = 1.0", "deadband_n = -0.1", "biopsy.deadband_n",
                     "-0.1", "a number from 0 to 100"},
        BrokenBiopsy{"deadband_is_no_number", "deadband_n = 1.0", "deadband_n = nan", "biopsy.deadband_n",
                     "nan", "a finite number"},
        BrokenBiopsy{"gain_too_large", "gain_mm_s_n = 1.0", "gain_mm_s_n = 101", "biopsy.gain_mm_s_n", "101",
                     "a number from 0.01 to 100"},
        BrokenBiopsy{"never_moves", "fastest_mm_s = 5.0", "fastest_mm_s = 0", "biopsy.fastest_mm_s", "0",
                     "a number from 0.1 to 100"},
        BrokenBiopsy{"straight_needle", "curvature_per_mm = 0.0041", "curvature_per_mm = 0",
                     "biopsy.curvature_per_mm", "0", "to 0.1"},
        BrokenBiopsy{"membranes_fall", "membranes_mm = [25.0, 50.0]", "membranes_mm = [50.0, 25.0]",
                     "biopsy.membranes_mm", "no depths of membranes", "each below the next"},
        BrokenBiopsy{"membrane_twice", "membranes_mm = [25.0, 50.0]", "membranes_mm = [25.0, 25.0]",
                     "biopsy.membranes_mm", "no depths of membranes", "each below the next"},
        BrokenBiopsy{"membrane_at_the_skin", "membranes_mm = [25.0, 50.0]", "membranes_mm = [0.0, 50.0]",
                     "biopsy.membranes_mm", "no depths of membranes", "above 0 to 500"},
        BrokenBiopsy{"membrane_too_deep", "membranes_mm = [25.0, 50.0]", "membranes_mm = [25.0, 500.5]",
                     "biopsy.membranes_mm", "no depths of membranes", "above 0 to 500"},
        BrokenBiopsy{"membrane_is_text", "membranes_mm = [25.0, 50.0]", "membranes_mm = [\"25\"]",
                     "biopsy.membranes_mm", "25", "at most 16 depths"},
        BrokenBiopsy{"too_many_membranes", "membranes_mm = [25.0, 50.0]",
                     "membranes_mm = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17]",
                     "biopsy.membranes_mm", "no depths of membranes", "at most 16"}),
    [](const auto& broken) { return broken.param.title; });

TEST(BiopsyTable, SixteenMembranesAreTaken) {
  std::string text = prostate_text();
  const std::string from = "membranes_mm = [25.0, 50.0]";
  text.replace(text.find(from), from.size(),
               "membranes_mm = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]");
  const auto robot = parse_robot(text, "many.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->biopsy->membranes_mm.size(), 16u);
}

}  // namespace
}  // namespace interlock
