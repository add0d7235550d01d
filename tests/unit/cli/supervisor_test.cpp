#include "cli/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <utility>

#include "cli/queued_output.hpp"
#include "scratch_folder.hpp"

// This header of glibc 2.36 does not say by itself that its functions are C.
extern "C" {
#include <sys/pidfd.h>
}

namespace interlock::cli {
namespace {

using testing::HasSubstr;

/** A shell as the supervised program: what it does is the text of the test. */
Supervised shell(const std::string& name, const std::string& script, AtEnd at_end = AtEnd::stop_all) {
  return {{name, "/bin/sh", {"-c", script}}, at_end};
}

const std::string stay = "exec tail -f /dev/null";

class SupervisorTest : public test::ScratchFolder {
 protected:
  Result<void> run(std::vector<Supervised> programs, const std::function<void()>& when_ready) {
    return Supervisor(std::move(programs), signals_, output_).run(when_ready);
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::size_t lines_in(const std::string& name) const {
    std::ifstream stream(folder_ / name);
    return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(stream), {}, '\n'));
  }

  static void ask_to_stop() { kill(getpid(), SIGTERM); }

  const SignalEvents signals_;
  std::ostringstream output_;
};

TEST_F(SupervisorTest, passes_a_first_login_on_as_it_is_and_gives_it_out_once) {
  Supervisor supervisor({shell("app", "echo first login: admin a b; echo ready; " + stay)}, signals_,
                        output_);
  std::string offered;
  ASSERT_TRUE(supervisor.run([&] {
    offered = supervisor.take_first_login();
    ask_to_stop();
  }));
  EXPECT_EQ(offered, "admin a b");
  EXPECT_EQ(supervisor.take_first_login(), "");
  EXPECT_THAT(output_.str(), testing::StartsWith("first login: admin a b\n"));
}

TEST_F(SupervisorTest, starts_each_program_when_the_one_before_is_ready) {
  const std::string order = file("order");
  const auto note = [&](const std::string& word) {
    return "echo " + word + " >>" + order + "; echo ready; ";
  };
  ASSERT_TRUE(
      run({shell("first", note("first") + stay), shell("second", note("second") + stay)}, ask_to_stop));
  std::ostringstream text;
  text << std::ifstream(order).rdbuf();
  EXPECT_EQ(text.str(), "first\nsecond\n");
}

TEST_F(SupervisorTest, forwards_both_outputs_under_the_name_of_the_program) {
  ASSERT_TRUE(run({shell("kernel", "echo hello; echo trouble >&2; echo ready; " + stay)}, ask_to_stop));
  EXPECT_THAT(output_.str(), HasSubstr("[kernel] hello\n[kernel] trouble\n[kernel] ready\n"));
}

TEST_F(SupervisorTest, stops_in_the_reverse_order_after_a_signal) {
  const auto note = [&](const std::string& word) {
    return "trap 'echo " + word + " >>" + file("order") + "; exit' TERM; echo ready; " +
           "tail -f /dev/null & while :; do wait; done";
  };
  ASSERT_TRUE(run(
      {shell("sim", note("sim")), shell("kernel", note("kernel")), shell("app", note("app"), AtEnd::restart)},
      ask_to_stop));
  std::ostringstream text;
  text << std::ifstream(file("order")).rdbuf();
  EXPECT_EQ(text.str(), "app\nkernel\nsim\n");
}

TEST_F(SupervisorTest, ends_with_the_cause_when_a_program_without_restarts_ends) {
  const auto result =
      run({shell("sim", "echo ready; " + stay), shell("kernel", "echo ready; echo last; kill -9 $$"),
           shell("app", "echo ready; " + stay, AtEnd::restart)},
          [] {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::process_ended);
  EXPECT_THAT(result.error().text, HasSubstr("kernel ended: killed by signal 9 (Killed)"));
  EXPECT_THAT(output_.str(), HasSubstr("[kernel] last\n"));
}

TEST_F(SupervisorTest, a_program_that_ends_before_it_is_ready_is_not_restarted) {
  const auto result = run({shell("app", "echo no port >&2; exit 3", AtEnd::restart)}, [] {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::process_ended);
  EXPECT_THAT(result.error().text, HasSubstr("app did not start: exit code 3"));
  EXPECT_THAT(output_.str(), HasSubstr("[app] no port\n"));
}

TEST_F(SupervisorTest, restarts_the_app_five_times_then_ends_with_the_cause) {
  const auto result =
      run({shell("kernel", "echo ready; " + stay),
           shell("app", "echo start >>" + file("starts") + "; echo ready; exit 7", AtEnd::restart)},
          [] {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::app_kept_ending);
  EXPECT_THAT(result.error().text, HasSubstr("app ended: exit code 7; it was restarted 5 times"));
  EXPECT_EQ(lines_in("starts"), 6u);
}

TEST_F(SupervisorTest, says_ready_again_after_a_restart_and_leaves_the_others_alone) {
  int ready = 0;
  ASSERT_TRUE(run({shell("kernel", "echo start >>" + file("kernel") + "; echo ready; " + stay),
                   shell("app",
                         "echo ready; if [ ! -e " + file("once") + " ]; then touch " + file("once") +
                             "; exit 1; fi; " + stay,
                         AtEnd::restart)},
                  [&] {
                    if (++ready == 2) {
                      ask_to_stop();
                    }
                  }));
  EXPECT_EQ(lines_in("kernel"), 1u);
  EXPECT_THAT(output_.str(), HasSubstr("app ended: exit code 1; restarting it (1 of 5 within a minute)"));
}

TEST_F(SupervisorTest, a_recorder_that_keeps_ending_is_left_and_takes_no_restart_from_the_app) {
  const std::string app = "echo start >>" + file("app") + "; echo ready; [ $(wc -l <" + file("app") +
                          ") -lt 6 ] && exit 1; " + stay;
  ASSERT_TRUE(run({shell("recorder", "echo start >>" + file("recorder") + "; echo ready; exit 7",
                         AtEnd::restart_or_leave),
                   shell("app", app, AtEnd::restart)},
                  [&] {
                    if (lines_in("app") == 6 &&
                        output_.str().find("not started again") != std::string::npos) {
                      ask_to_stop();
                    }
                  }));
  EXPECT_EQ(lines_in("recorder"), 6u);
  EXPECT_THAT(
      output_.str(),
      HasSubstr("recorder ended: exit code 7; it was restarted 5 times within a minute already, so it is "
                "not started again; all else goes on without it"));
}

TEST_F(SupervisorTest, two_that_die_together_are_started_once_each) {
  const auto program = [&](const std::string& name) {
    return shell(name, "echo $$ >>" + file(name) + "; echo ready; " + stay, AtEnd::restart);
  };
  const auto kill_first = [&](const std::string& name) {
    pid_t pid = 0;
    std::ifstream(file(name)) >> pid;
    kill(pid, SIGKILL);
  };
  bool killed = false;
  ASSERT_TRUE(run({program("recorder"), program("app")}, [&] {
    if (!std::exchange(killed, true)) {
      kill_first("recorder");
      kill_first("app");
    } else if (lines_in("recorder") == 2 && lines_in("app") == 2) {
      ask_to_stop();
    }
  }));
  EXPECT_EQ(lines_in("recorder"), 2u);
  EXPECT_EQ(lines_in("app"), 2u);
  EXPECT_THAT(output_.str(), testing::Not(HasSubstr("(2 of 5")));
}

TEST_F(SupervisorTest, who_gives_no_sign_of_life_is_killed_and_its_end_judged_as_any) {
  Supervised silent = shell("app", "ulimit -c 0; echo ready; " + stay, AtEnd::restart);
  silent.program.watchdog = std::chrono::milliseconds(100);
  const auto result = run({silent}, [] {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::app_kept_ending);
  EXPECT_THAT(result.error().text,
              HasSubstr("app ended: killed by signal 6 (Aborted); it was restarted 5 times"));
  EXPECT_THAT(output_.str(), HasSubstr("app gave no sign of life for 0.1 s; ending it"));
}

TEST_F(SupervisorTest, who_is_stopped_and_cannot_abort_is_killed) {
  Supervised stopped = shell("app", "ulimit -c 0; echo ready; kill -STOP $$");
  stopped.program.watchdog = std::chrono::milliseconds(100);
  stopped.longest_end = std::chrono::seconds(1);
  const auto result = run({stopped}, [] {});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().text, HasSubstr("app ended: killed by signal 9 (Killed)"));
  EXPECT_THAT(output_.str(), HasSubstr("app did not end in time; killing it"));
}

/** Waits for the lines of a child up to the first that is not empty. */
std::string first_line_of(ChildProcess& child) {
  while (true) {
    pollfd output{child.output_fd(), POLLIN, 0};
    poll(&output, 1, -1);
    if (const auto lines = child.read_lines(false); !lines.empty()) {
      return lines.front();
    }
  }
}

TEST(ChildProcess, only_the_child_itself_can_give_its_sign_of_life) {
  Program program{"app", "/bin/sh", {"-c", "echo $NOTIFY_SOCKET $WATCHDOG_USEC; " + stay}};
  program.watchdog = std::chrono::seconds(5);
  auto child = ChildProcess::start(program);
  ASSERT_TRUE(child);
  const std::string told = first_line_of(*child);
  EXPECT_THAT(told, testing::MatchesRegex("@.* 5000000"));
  sockaddr_un address{AF_UNIX, {}};
  const std::size_t length = told.find(' ');
  told.copy(address.sun_path, length);
  address.sun_path[0] = '\0';
  const FileDescriptor stranger(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const std::string word = "WATCHDOG=1";
  ASSERT_EQ(sendto(stranger.get(), word.data(), word.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                   static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length)),
            static_cast<ssize_t>(word.size()));
  EXPECT_FALSE(child->gave_sign_of_life());
}

TEST(ChildProcess, a_sign_of_life_counts_once) {
  const std::string script =
      "import os, socket, signal\n"
      "name = os.environ['NOTIFY_SOCKET'].replace('@', chr(0), 1)\n"
      "socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b'WATCHDOG=1', name)\n"
      "print('sent', flush=True)\n"
      "signal.pause()\n";
  Program program{"app", "/usr/bin/env", {"python3", "-c", script}};
  program.watchdog = std::chrono::seconds(5);
  auto child = ChildProcess::start(program);
  ASSERT_TRUE(child);
  ASSERT_EQ(first_line_of(*child), "sent");
  EXPECT_TRUE(child->gave_sign_of_life());
  EXPECT_FALSE(child->gave_sign_of_life());
}

TEST(ChildProcess, the_service_manager_of_the_parent_is_not_the_childs) {
  setenv("NOTIFY_SOCKET", "/nowhere", 1);
  setenv("WATCHDOG_USEC", "1", 1);
  auto child = ChildProcess::start({"kernel", "/bin/sh", {"-c", "echo none$NOTIFY_SOCKET$WATCHDOG_USEC"}});
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  ASSERT_TRUE(child);
  EXPECT_EQ(first_line_of(*child), "none");
}

TEST_F(SupervisorTest, goes_on_while_nobody_reads_its_output) {
  const std::size_t lines = 20'000;
  const std::string chatter = "i=0; while [ $i -lt " + std::to_string(lines) + " ]; do echo " +
                              std::string(100, 'x') + "; i=$((i+1)); done; ";
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  const FileDescriptor reader(ends[0]);
  const FileDescriptor writer(ends[1]);
  QueuedOutput unread(writer.get());
  Supervisor supervisor({shell("app",
                               chatter + "echo ready; [ ! -e " + file("once") + " ] && touch " +
                                   file("once") + " && exit 1; " + stay,
                               AtEnd::restart)},
                        signals_, unread.stream());
  int ready = 0;
  EXPECT_TRUE(supervisor.run([&] {
    if (++ready == 2) {
      ask_to_stop();
    }
  }));
}

TEST_F(SupervisorTest, leaves_no_child_whichever_way_it_ends) {
  for (const char* const last : {"echo ready; exit 1", "exit 1"}) {
    ASSERT_FALSE(run({shell("sim", "echo ready; " + stay), shell("kernel", last)}, [] {}));
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
}

TEST_F(SupervisorTest, takes_along_what_a_child_has_started) {
  FileDescriptor grandchild;
  ASSERT_TRUE(
      run({shell("kernel", "tail -f /dev/null & echo $! >" + file("pid") + "; echo ready; wait")}, [&] {
        pid_t pid = 0;
        std::ifstream(file("pid")) >> pid;
        grandchild = FileDescriptor(pidfd_open(pid, 0));
        ask_to_stop();
      }));
  pollfd ended{grandchild.get(), POLLIN, 0};
  EXPECT_EQ(poll(&ended, 1, -1), 1);
}

TEST_F(SupervisorTest, a_second_signal_kills_what_does_not_end) {
  const std::string deaf = "trap : TERM; kill -TERM $PPID; echo ready; while :; do kill -TERM $PPID; done";
  EXPECT_TRUE(run({shell("deaf", deaf)}, [] {}));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST_F(SupervisorTest, a_program_that_cannot_be_run_is_named_with_the_reason) {
  const auto result = run({{{"kernel", folder_ / "missing", {}}}}, [] {});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().text, HasSubstr("kernel did not start: exit code 127"));
  EXPECT_THAT(output_.str(), HasSubstr("[kernel] cannot be run: No such file or directory"));
}

TEST_F(SupervisorTest, a_line_without_end_is_cut_and_still_forwarded) {
  ASSERT_TRUE(run({shell("kernel", "head -c 100000 /dev/zero | tr '\\0' x; echo; echo ready; " + stay)},
                  ask_to_stop));
  EXPECT_THAT(output_.str(), HasSubstr("[kernel] " + std::string(65536, 'x') + "\n[kernel] xxx"));
}

TEST_F(SupervisorTest, who_says_ready_twice_is_ready_once) {
  const std::string twice = "echo ready; echo ready; ";
  ASSERT_TRUE(run(
      {shell("sim", twice + stay), shell("kernel", "echo start >>" + file("starts") + "; " + twice + stay),
       shell("app", "echo ready; " + stay)},
      ask_to_stop));
  EXPECT_EQ(lines_in("starts"), 1u);
}

TEST_F(SupervisorTest, only_a_whole_word_is_readiness) {
  const auto result = run({shell("kernel", "echo readying; exit 1")}, [] {});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().text, HasSubstr("did not start"));
}

}  // namespace
}  // namespace interlock::cli
