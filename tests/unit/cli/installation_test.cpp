#include "cli/installation.hpp"

#include "scratch_folder.hpp"

namespace interlock::cli {
namespace {

using testing::HasSubstr;

class InstallationTest : public test::ScratchFolder {
 protected:
  Installation installation() const { return {folder_ / "bin", {folder_ / "share", folder_ / "source"}}; }
};

TEST_F(InstallationTest, what_looks_like_a_file_is_taken_as_it_is) {
  EXPECT_EQ(installation().robot("mine.toml").value(), "mine.toml");
  EXPECT_EQ(installation().robot("some/robot").value(), "some/robot");
}

TEST_F(InstallationTest, a_robot_is_found_by_name_in_the_first_root_that_has_it) {
  const auto in_source = touch("source/models/robots/neuro.toml");
  EXPECT_EQ(installation().robot("neuro").value(), in_source);
  const auto in_share = touch("share/models/robots/neuro.toml");
  EXPECT_EQ(installation().robot("neuro").value(), in_share);
}

TEST_F(InstallationTest, a_robot_that_is_nowhere_names_every_place_that_was_looked_at) {
  const auto robot = installation().robot("neuro");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().code, ExitCode::precondition);
  EXPECT_THAT(robot.error().text, HasSubstr((folder_ / "share/models/robots/neuro.toml").string()));
  EXPECT_THAT(robot.error().text, HasSubstr((folder_ / "source/models/robots/neuro.toml").string()));
}

TEST_F(InstallationTest, a_program_must_be_there_and_executable) {
  EXPECT_FALSE(installation().program("interlock-sim"));
  const auto file = touch("bin/interlock-sim");
  EXPECT_FALSE(installation().program("interlock-sim"));
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  EXPECT_EQ(installation().program("interlock-sim").value(), file);
}

TEST_F(InstallationTest, sources_of_the_console_are_no_console) {
  touch("source/web/index.html");
  EXPECT_EQ(installation().web(), std::nullopt);
  touch("source/web/dist/assets/index.js");
  EXPECT_EQ(installation().web(), folder_ / "source/web/dist");
}

TEST_F(InstallationTest, documents_are_there_once_they_were_built) {
  touch("source/docs/manual.md");
  EXPECT_EQ(installation().documents(), std::nullopt);
  touch("source/build/docs/site/index.html");
  EXPECT_EQ(installation().documents(), folder_ / "source/build/docs/site");
  touch("share/documents/index.html");
  EXPECT_EQ(installation().documents(), folder_ / "share/documents");
}

}  // namespace
}  // namespace interlock::cli
