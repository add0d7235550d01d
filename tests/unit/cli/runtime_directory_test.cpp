#include "cli/runtime_directory.hpp"

#include "scratch_folder.hpp"

namespace interlock::cli {
namespace {

using testing::HasSubstr;

class RuntimeDirectoryTest : public test::ScratchFolder {
 protected:
  RuntimeDirectoryTest() { setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1); }
  ~RuntimeDirectoryTest() override { unsetenv("XDG_RUNTIME_DIR"); }

  bool is_empty() const { return std::filesystem::is_empty(folder_); }
};

TEST_F(RuntimeDirectoryTest, a_private_one_is_ours_alone_and_goes_with_all_that_is_in_it) {
  {
    const auto directory = RuntimeDirectory::make_private("neuro");
    ASSERT_TRUE(directory);
    EXPECT_TRUE(directory->is_private());
    EXPECT_EQ(std::filesystem::status(directory->path()).permissions(), std::filesystem::perms::owner_all);
    std::ofstream(directory->bus()) << "left";
    std::ofstream(directory->path() / "another") << "left";
  }
  EXPECT_TRUE(is_empty());
}

TEST_F(RuntimeDirectoryTest, two_private_ones_differ) {
  const auto first = RuntimeDirectory::make_private("neuro");
  const auto second = RuntimeDirectory::make_private("neuro");
  EXPECT_NE(first->path(), second->path());
}

TEST_F(RuntimeDirectoryTest, a_given_one_loses_the_files_of_this_run_and_no_others) {
  const auto other = touch("given/notes");
  {
    const auto directory = RuntimeDirectory::use(folder_ / "given", "neuro");
    ASSERT_TRUE(directory) << directory.error().text;
    EXPECT_FALSE(directory->is_private());
    for (const auto& file :
         {directory->bus(), directory->control(), directory->link(), directory->config()}) {
      std::ofstream(file) << "left";
    }
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "given"), {}), 1);
  EXPECT_TRUE(std::filesystem::exists(other));
}

TEST_F(RuntimeDirectoryTest, a_given_one_with_the_socket_of_another_run_is_refused_and_left_as_it_is) {
  const auto socket = touch("given/bus.sock");
  const auto directory = RuntimeDirectory::use(folder_ / "given", "neuro");
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().code, ExitCode::precondition);
  EXPECT_THAT(directory.error().text, HasSubstr(socket.string() + " is there already"));
  EXPECT_TRUE(std::filesystem::exists(socket));
}

TEST_F(RuntimeDirectoryTest, a_path_too_long_for_a_socket_is_refused_before_anything_starts) {
  const auto directory = RuntimeDirectory::use(folder_ / std::string(120, 'd'), "neuro");
  ASSERT_FALSE(directory);
  EXPECT_THAT(directory.error().text, HasSubstr("too long"));
}

TEST_F(RuntimeDirectoryTest, a_file_in_the_place_of_a_given_one_is_refused) {
  const auto directory = RuntimeDirectory::use(touch("file"), "neuro");
  ASSERT_FALSE(directory);
  EXPECT_THAT(directory.error().text, HasSubstr("Not a directory"));
}

}  // namespace
}  // namespace interlock::cli
