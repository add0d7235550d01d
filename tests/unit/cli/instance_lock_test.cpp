#include "cli/instance_lock.hpp"

#include "scratch_folder.hpp"

namespace interlock::cli {
namespace {

using testing::HasSubstr;

class InstanceLockTest : public test::ScratchFolder {
 protected:
  /** As a killed instance leaves it: described, not emptied. */
  void leave_lock_file(const std::filesystem::path& runtime_directory) const {
    std::ofstream(touch("state/lock")) << "4711\nhttp://127.0.0.1:8080/\n"
                                       << runtime_directory.string() << '\n';
  }
};

TEST_F(InstanceLockTest, a_second_instance_is_refused_and_told_who_holds_the_directory) {
  const auto first = InstanceLock::take(folder_ / "state");
  ASSERT_TRUE(first);
  first->describe("http://127.0.0.1:8081/", "/run/interlock-neuro-abc", "/run/interlock-neuro-abc/box");
  const auto second = InstanceLock::take(folder_ / "state");
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ExitCode::precondition);
  EXPECT_THAT(second.error().text, HasSubstr((folder_ / "state").string()));
  EXPECT_THAT(second.error().text, HasSubstr("process " + std::to_string(getpid())));
  EXPECT_THAT(second.error().text, HasSubstr("http://127.0.0.1:8081/"));
}

TEST_F(InstanceLockTest, the_black_box_of_an_instance_is_known_while_it_runs) {
  EXPECT_FALSE(running_black_box(folder_));
  {
    const auto lock = InstanceLock::take(folder_);
    ASSERT_TRUE(lock);
    EXPECT_FALSE(running_black_box(folder_));
    lock->describe("http://127.0.0.1:8081/", "", "/run/interlock-neuro-abc/box");
    EXPECT_EQ(running_black_box(folder_), "/run/interlock-neuro-abc/box");
  }
  EXPECT_FALSE(running_black_box(folder_));
}

TEST_F(InstanceLockTest, the_directory_is_free_when_its_holder_is_gone) {
  {
    ASSERT_TRUE(InstanceLock::take(folder_));
  }
  EXPECT_TRUE(InstanceLock::take(folder_));
}

TEST_F(InstanceLockTest, an_orderly_end_leaves_an_empty_lock_file) {
  {
    const auto lock = InstanceLock::take(folder_);
    ASSERT_TRUE(lock);
    lock->describe("http://127.0.0.1:8081/", "/run/interlock-neuro-abc", "/run/interlock-neuro-abc/box");
  }
  EXPECT_EQ(std::filesystem::file_size(folder_ / "lock"), 0u);
}

TEST_F(InstanceLockTest, what_a_killed_instance_left_is_removed) {
  const auto socket = touch("interlock-neuro-abc/bus.sock");
  leave_lock_file(socket.parent_path());
  ASSERT_TRUE(InstanceLock::take(folder_ / "state"));
  EXPECT_FALSE(std::filesystem::exists(socket.parent_path()));
}

TEST_F(InstanceLockTest, nothing_else_is_ever_removed) {
  const auto file = touch("patients/list");
  leave_lock_file(file.parent_path());
  ASSERT_TRUE(InstanceLock::take(folder_ / "state"));
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST_F(InstanceLockTest, a_directory_that_cannot_be_made_is_named) {
  touch("file");
  const auto lock = InstanceLock::take(folder_ / "file" / "state");
  ASSERT_FALSE(lock);
  EXPECT_THAT(lock.error().text, HasSubstr("file/state/lock: Not a directory"));
}

}  // namespace
}  // namespace interlock::cli
