/**
 * @file
 * The store with other processes: writers at the same time, writers that are killed, disks that are full.
 */
#include <fcntl.h>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>

#include "store/settings.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

/** A `store_writer` on its way. It is killed when this goes. */
class Writer {
 public:
  Writer(const std::filesystem::path& file, int count) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("no pipe");
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::string path = file.string();
    std::string number = std::to_string(count);
    std::string program = STORE_WRITER;
    std::array<char*, 4> arguments{program.data(), path.data(), number.data(), nullptr};
    const int failed = ::posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    output_ = ends[0];
    if (failed != 0) {
      throw std::runtime_error("no store_writer");
    }
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() {
    end(SIGKILL);
    ::close(output_);
  }

  /** Reads until that many counts were acknowledged, or the writer ends. */
  void wait_for(int lines) {
    char byte = 0;
    while (lines > 0 && ::read(output_, &byte, 1) == 1) {
      text_ += byte;
      lines -= byte == '\n' ? 1 : 0;
    }
  }

  /** Sends the signal, 0 for none, waits for the end and returns how it ended. */
  int end(int signal) {
    if (pid_ > 0) {
      if (signal != 0) {
        ::kill(pid_, signal);
      }
      ::waitpid(pid_, &status_, 0);
      pid_ = -1;
    }
    return status_;
  }

  /** The last count that was acknowledged, 0 for none; to be asked after the end. */
  int last_acknowledged() {
    wait_for(std::numeric_limits<int>::max());
    const std::size_t last = text_.find_last_of('\n');
    if (last == std::string::npos) {
      return 0;
    }
    const std::size_t before = text_.find_last_of('\n', last - 1);
    return std::stoi(text_.substr(before == std::string::npos ? 0 : before + 1));
  }

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  int status_ = 0;
  std::string text_;
};

class StoreProcess : public StoreTest {
 protected:
  /** The count and the number of records, which are the same if each transaction is there as a whole. */
  std::pair<std::int64_t, std::int64_t> count_and_records() {
    Store store = open();
    return seen(store, [](Transaction& transaction) {
      const auto head = Audit(transaction).verify();
      const auto count = Settings(transaction).find("count");
      return std::pair(count ? count->value.get<std::int64_t>() : 0, head ? head->number : -1);
    });
  }
};

TEST_F(StoreProcess, WhatWasAcknowledgedSurvivesSigkillAtAnyInstant) {
  std::mt19937 random(2026);
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    Writer writer(file_, 1000000);
    writer.wait_for(std::uniform_int_distribution(0, 5)(random));
    // The instant of the kill, anywhere within the next transaction, or the opening of the store.
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 5000)(random)));
    writer.end(SIGKILL);
    const auto [count, records] = count_and_records();
    ASSERT_EQ(count, records);
    ASSERT_GE(records, writer.last_acknowledged());
  }
  EXPECT_GT(count_and_records().second, 100);
}

TEST_F(StoreProcess, WritersAtTheSameTimeWaitForEachOther) {
  constexpr int writers = 4;
  constexpr int each = 25;
  {
    std::array<std::unique_ptr<Writer>, writers> running;
    for (auto& writer : running) {
      writer = std::make_unique<Writer>(file_, each);
    }
    for (auto& writer : running) {
      EXPECT_EQ(writer->end(0), 0);
    }
  }
  EXPECT_EQ(count_and_records(), std::pair(std::int64_t{writers * each}, std::int64_t{writers * each}));
}

TEST_F(StoreProcess, CommandBesideTheAppWaitsForItsTransaction) {
  Store app = open();
  std::optional<Writer> writer;
  commit(app, [&](Transaction& transaction) {
    writer.emplace(file_, 1);
    Settings(transaction).set("count", 41, noon);
    for (int number = 0; number < 41; ++number) {
      Audit(transaction).append({});
    }
  });
  EXPECT_EQ(writer->end(0), 0);
  EXPECT_EQ(writer->last_acknowledged(), 42);
}

/** Limits the size of every file that this process writes. */
void limit_files(rlim_t bytes) {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = std::min(bytes, limit.rlim_max);
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

/** Exit code 0 if the store refuses a write that does not fit, changes nothing, and works again with room. */
[[noreturn]] void run_out_of_room(const std::filesystem::path& file) {
  std::signal(SIGXFSZ, SIG_IGN);
  Stored<Store> store = Store::open(file);
  const auto set = [&](const std::string& value) {
    return store->transact([&](Transaction& transaction) -> Stored<void> {
      Settings(transaction).set("key", value, noon);
      Audit(transaction).append({});
      return {};
    });
  };
  const auto is_small = [&] {
    return store
        ->read([](Transaction& transaction) -> Stored<bool> {
          return Settings(transaction).find("key")->value == "small" &&
                 Audit(transaction).verify()->number == 1;
        })
        .value();
  };
  bool right = set("small").has_value();
  limit_files(256 * 1024);
  const auto refused = set(std::string(1024 * 1024, 'x'));
  limit_files(RLIM_INFINITY);
  right = right && !refused && refused.error().kind == StoreError::Kind::unavailable;
  right = right && is_small() && set("again").has_value();
  std::_Exit(right ? 0 : 1);
}

TEST_F(StoreProcess, FullDiskIsAnErrorThatChangesNothing) {
  EXPECT_EXIT(run_out_of_room(file_), testing::ExitedWithCode(0), "");
}

/** Exit code 0 if opening is refused for somebody who may not read the folder. */
[[noreturn]] void open_without_rights(const std::filesystem::path& file) {
  if (::geteuid() == 0 && ::setuid(65534) != 0) {
    std::_Exit(2);
  }
  const Stored<Store> store = Store::open(file);
  std::_Exit(!store && store.error().kind == StoreError::Kind::unavailable ? 0 : 1);
}

TEST_F(StoreProcess, UnreadableStoreIsAnError) {
  {
    Store made = open();
  }
  std::filesystem::permissions(folder_, std::filesystem::perms::none);
  EXPECT_EXIT(open_without_rights(file_), testing::ExitedWithCode(0), "");
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
}

}  // namespace
}  // namespace interlock
