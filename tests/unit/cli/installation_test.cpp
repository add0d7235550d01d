#include "cli/installation.hpp"

#include "scratch_folder.hpp"

namespace interlock::cli {
namespace {

using testing::HasSubstr;

class InstallationTest : public test::ScratchFolder {
 protected:
  Installation installation() const { return {folder_ / "bin", folder_ / "data"}; }
};

TEST_F(InstallationTest, what_looks_like_a_file_is_taken_as_it_is) {
  EXPECT_EQ(installation().robot("mine.toml").value(), "mine.toml");
  EXPECT_EQ(installation().robot("some/robot").value(), "some/robot");
}

TEST_F(InstallationTest, a_robot_is_found_by_name) {
  const auto file = touch("data/models/robots/neuro.toml");
  EXPECT_EQ(installation().robot("neuro").value(), file);
}

TEST_F(InstallationTest, a_robot_that_is_nowhere_names_the_place_that_was_looked_at) {
  const auto robot = installation().robot("neuro");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().code, ExitCode::precondition);
  EXPECT_THAT(robot.error().text, HasSubstr((folder_ / "data/models/robots/neuro.toml").string()));
}

TEST_F(InstallationTest, a_program_must_be_there_and_executable) {
  EXPECT_FALSE(installation().program("interlock-sim"));
  const auto file = touch("bin/interlock-sim");
  EXPECT_FALSE(installation().program("interlock-sim"));
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  EXPECT_EQ(installation().program("interlock-sim").value(), file);
}

TEST_F(InstallationTest, sources_of_the_console_are_no_console) {
  touch("data/web/index.html");
  EXPECT_EQ(installation().web(), std::nullopt);
  touch("data/web/dist/assets/index.js");
  EXPECT_EQ(installation().web(), folder_ / "data/web/dist");
}

TEST_F(InstallationTest, documents_are_there_once_they_were_built) {
  touch("data/docs/manual.md");
  EXPECT_EQ(installation().documents(), std::nullopt);
  touch("data/build/docs/site/index.html");
  EXPECT_EQ(installation().documents(), folder_ / "data/build/docs/site");
  touch("data/documents/index.html");
  EXPECT_EQ(installation().documents(), folder_ / "data/documents");
}

}  // namespace
}  // namespace interlock::cli
