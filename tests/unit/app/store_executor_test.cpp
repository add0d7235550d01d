#include <SQLiteCpp/SQLiteCpp.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/use_future.hpp>

#include "http_fixture.hpp"
#include "store/settings.hpp"

namespace interlock::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::chrono::milliseconds short_timeout{50};
constexpr std::chrono::minutes long_timeout{10};

/** Sets a value in the store. */
struct Set {
  std::string key;
  UtcTime time;

  Stored<void> operator()(Store& store) const {
    return store.transact([this](Transaction& transaction) -> Stored<void> {
      Settings(transaction).set(key, true, time);
      return {};
    });
  }
};

class StoreExecutorTest : public StoreFixture {
 protected:
  ~StoreExecutorTest() override {
    working_.reset();
    thread_.join();
  }

  template <typename Work>
  auto ask(StoreExecutor& executor, Work work) {
    return asio::co_spawn(network_, executor.run(std::move(work)), asio::use_future);
  }

  void note(StoreExecutor& executor, int number) {
    asio::post(network_, [this, &executor, number] {
      executor.note(
          {now(), std::nullopt, audit_actor::app, std::nullopt, AuditKind::verdict, {{"n", number}}});
    });
  }

  bool is_set(const std::string& key) {
    return *mine_.read([&](Transaction& transaction) -> Stored<bool> {
      return Settings(transaction).find(key).has_value();
    });
  }

  void execute(const char* sql) {
    ASSERT_TRUE(mine_.transact([&](Transaction& transaction) -> Stored<void> {
      transaction.database().exec(sql);
      return {};
    }));
  }

  /** From now on no record can be written. */
  void refuse_records() {
    execute("CREATE TRIGGER no_records BEFORE INSERT ON audit BEGIN SELECT RAISE(ABORT, 'refused'); END");
  }
  void take_records() { execute("DROP TRIGGER no_records"); }

  std::vector<int> recorded() {
    std::vector<int> numbers;
    for (const json& detail : audit("verdict")) {
      numbers.push_back(detail["n"]);
    }
    return numbers;
  }

  asio::io_context network_{1};
  std::optional<asio::executor_work_guard<asio::io_context::executor_type>> working_{network_.get_executor()};
  StoreExecutor hasty_{network_.get_executor(), store_, short_timeout};
  StoreExecutor patient_{network_.get_executor(), store_, long_timeout};
  std::jthread thread_{[this] { network_.run(); }};
};

TEST_F(StoreExecutorTest, WhoIsToldThatTheStoreDoesNotAnswerHasChangedNothingEvenLater) {
  (void)mine_.transact([&](Transaction&) -> Stored<void> {
    const auto late = ask(hasty_, Set{"late", now()}).get();
    EXPECT_FALSE(late);
    EXPECT_EQ(late.error().status, Status::service_unavailable);
    EXPECT_EQ(late.error().code, "STORE");
    EXPECT_THAT(late.error().detail, HasSubstr("nothing was changed"));
    return {};
  });
  auto seen = ask(hasty_, [](Store&) -> Stored<int> { return 1; });
  while (!seen.get()) {
    seen = ask(hasty_, [](Store&) -> Stored<int> { return 1; });
  }
  EXPECT_FALSE(is_set("late"));
}

TEST_F(StoreExecutorTest, WorkThatNobodyWaitsForIsNotBegun) {
  std::promise<void> release;
  std::atomic<bool> begun = false;
  auto blocking = ask(hasty_, [held = release.get_future().share()](Store&) -> Stored<void> {
    held.wait();
    return {};
  });
  EXPECT_FALSE(ask(hasty_, [&](Store&) -> Stored<void> {
                 begun = true;
                 return {};
               }).get());
  release.set_value();
  EXPECT_FALSE(blocking.get());
  while (!ask(hasty_, [](Store&) -> Stored<int> { return 1; }).get()) {
  }
  EXPECT_FALSE(begun);
}

TEST_F(StoreExecutorTest, ACommitOnItsWayToTheDiskIsWaitedForAndThenCalledUnknown) {
  std::promise<void> release;
  auto stuck = ask(hasty_, [held = release.get_future().share(), this](Store& store) -> Stored<void> {
    const auto kept = Set{"kept", now()}(store);
    held.wait();
    return kept;
  });
  const auto told = stuck.get();
  EXPECT_EQ(told.error().code, "STORE");
  EXPECT_THAT(told.error().detail, HasSubstr("not known"));
  EXPECT_TRUE(is_set("kept"));
  release.set_value();
}

TEST_F(StoreExecutorTest, NotesThatCannotBeWrittenComeLaterInTheirOrder) {
  refuse_records();
  for (int number = 1; number <= 3; ++number) {
    note(patient_, number);
    EXPECT_FALSE(ask(patient_, Set{"after a note", now()}).get())
        << "nothing is changed past a missing record";
  }
  EXPECT_FALSE(is_set("after a note"));
  EXPECT_TRUE(recorded().empty());
  take_records();
  note(patient_, 4);
  EXPECT_TRUE(ask(patient_, Set{"after a note", now()}).get());
  EXPECT_THAT(recorded(), ElementsAre(1, 2, 3, 4));
}

TEST_F(StoreExecutorTest, WhatWasLostIsRecorded) {
  refuse_records();
  for (std::size_t number = 0; number < AuditNotes::capacity + 5; ++number) {
    note(patient_, static_cast<int>(number));
  }
  EXPECT_FALSE(ask(patient_, Set{"x", now()}).get());
  take_records();
  EXPECT_TRUE(ask(patient_, Set{"x", now()}).get());
  EXPECT_THAT(audit("records_lost"), ElementsAre(json{{"count", 5}}));
}

TEST_F(StoreExecutorTest, WhatIsReadIsReadWhileNothingCanBeWritten) {
  refuse_records();
  note(patient_, 1);
  EXPECT_TRUE(ask(patient_, [](Store& store) {
                return store.read([](Transaction&) -> Stored<int> { return 1; });
              }).get());
}

}  // namespace
}  // namespace interlock::web
