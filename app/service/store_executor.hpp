/**
 * @file
 * The way from the network thread to the store, which has a thread of its own: the network never waits for
 * the disk, and nobody waits for it without an end.
 */
#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstddef>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "service/reply.hpp"
#include "store/audit.hpp"
#include "store/store.hpp"

namespace interlock {

/**
 * What somebody who waits and the store's thread agree upon about one piece of work: either it is committed
 * or it is given up, never both.
 */
class CommitToken {
 public:
  /** Whether nobody waits for it any more: it is not to be begun, and must not be committed. */
  [[nodiscard]] bool abandoned() const { return state_.load() == State::abandoned; }

  /** The store is about to commit; false when nobody waits for it any more. */
  bool begin_commit() {
    State open = State::open;
    return state_.compare_exchange_strong(open, State::committing) || open == State::committing;
  }

  /** Nobody waits for it any more; false when it is being committed already. */
  bool abandon() {
    State open = State::open;
    return state_.compare_exchange_strong(open, State::abandoned) || open == State::abandoned;
  }

 private:
  enum class State { open, committing, abandoned };

  std::atomic<State> state_ = State::open;
};

// Audit records that are written behind: they wait here, in their order, until the store takes them.

/** Any thread may add; one thread at a time takes. */
class AuditNotes {
 public:
  /** Records that are written together. */
  using Batch = std::list<AuditEntry>;

  /** Records that wait, those that were taken and not confirmed among them. Beyond them the newest are lost;
   * a record of kind `records_lost` in their place says how many, and since when. */
  static constexpr std::size_t capacity = 4096;

  /** False: it is lost, and counted. */
  bool add(AuditEntry entry);

  /** Everything that waits, oldest first, to be written now and then either confirmed or given back. */
  Batch take();

  /** What was taken is on the disk. */
  void confirm();

  /** What was taken could not be written: it waits again, before whatever came meanwhile. */
  void give_back(Batch batch);

  /** Whether no record waits. */
  [[nodiscard]] bool empty() const;

 private:
  mutable std::mutex mutex_;
  Batch waiting_;
  std::size_t taken_ = 0;
};

// The way from the network thread to the store, which has a thread of its own: the network never waits for
// the disk, and nobody waits for it without an end.

/** 401 LOGIN, 403 ROLE, 422 INVALID, 404, 409 EXISTS or LAST_ADMIN, or 503 STORE when the file fails. */
Problem problem_of(const StoreError& error);

/** Runs work in the thread of the store, and brings back what came of it. */
class StoreExecutor {
 public:
  /** How long somebody waits for the store before being told that it does not answer. */
  static constexpr std::chrono::milliseconds usual_timeout{5000};

  /** `network` is the executor of the thread that uses it; `store` must outlive it. */
  StoreExecutor(boost::asio::any_io_executor network, Store& store,
                std::chrono::milliseconds timeout = usual_timeout);

  /** Writes what was noted, as far as the store takes it. */
  ~StoreExecutor();

  StoreExecutor(const StoreExecutor&) = delete;
  StoreExecutor& operator=(const StoreExecutor&) = delete;

  /**
   * Runs `work(Store&)`, which returns a `Stored<...>` and commits at most one transaction, in the store's
   * thread, after everything that was asked for or noted before. Errors and exceptions become the problem of
   * `problem_of`. What was noted before and cannot be written lets nothing be committed after it.
   *
   * 503 STORE when it takes longer than the timeout: then nothing was and nothing will be committed. Only a
   * COMMIT that is on its way to the disk is waited for once as long again; if it takes longer than that, the
   * problem says that nobody knows what became of it.
   *
   * Pass a named `work` by `std::move`: GCC 12 destroys twice what a temporary inside `co_await` captured.
   */
  template <typename Work>
  auto run(Work work) -> boost::asio::awaitable<
      tl::expected<typename std::invoke_result_t<Work, Store&>::value_type, Problem>> {
    using Result = std::invoke_result_t<Work, Store&>;
    const auto wait = std::make_shared<WaitFor<Result>>(network_);
    boost::asio::post(pool_, [this, wait, work = std::move(work)]() mutable {
      if (!wait->order.abandoned()) {
        auto [result, noted] = in_store(wait->order, work);
        report(wait, std::move(result), std::move(noted));
      }
    });
    co_await patiently(*wait);
    if (!wait->result) {
      co_return tl::make_unexpected(too_late(wait->order));
    }
    co_return std::move(*wait->result).map_error([](const StoreError& error) { return problem_of(error); });
  }

  /** Writes a record soon, and those that are noted at about the same time with it. Nobody waits for it. */
  void note(AuditEntry entry);

 private:
  /** One who waits for the store. */
  struct Wait {
    explicit Wait(const boost::asio::any_io_executor& network) : timer(network) {}

    CommitToken order;
    boost::asio::steady_timer timer; /**< of the network thread; cancelled when it is done */
    bool done = false;
  };

  template <typename Result>
  struct WaitFor : Wait {
    using Wait::Wait;
    std::optional<Result> result;
  };

  /** In the store's thread: the notes, then the work. */
  template <typename Work>
  auto in_store(CommitToken& order, Work& work)
      -> std::pair<std::invoke_result_t<Work, Store&>, Stored<void>> {
    Stored<void> noted = write_notes();
    store_.check_commits([&] { return may_commit(order, noted); });
    auto result = caught(work);
    store_.check_commits(Store::commit_always);
    return {std::move(result), std::move(noted)};
  }

  template <typename Work>
  auto caught(Work& work) -> std::invoke_result_t<Work, Store&> {
    try {
      return work(store_);
    } catch (const std::exception& exception) {
      return tl::make_unexpected(StoreError{StoreError::Kind::unavailable, exception.what(), "", "", ""});
    }
  }

  template <typename Result>
  void report(const std::shared_ptr<WaitFor<Result>>& wait, Result result, Stored<void> noted) {
    boost::asio::post(network_, [this, wait, result = std::move(result), noted = std::move(noted)]() mutable {
      watch(!noted ? &noted.error() : !result ? &result.error() : nullptr);
      wait->result = std::move(result);
      wait->done = true;
      wait->timer.cancel();
    });
  }

  static Stored<void> may_commit(CommitToken& order, const Stored<void>& noted);
  boost::asio::awaitable<void> patiently(Wait& wait) const;
  Problem too_late(const CommitToken& order);
  void send_notes();
  Stored<void> write_notes();
  void watch(const StoreError* error);

  boost::asio::any_io_executor network_;
  Store& store_;
  std::chrono::milliseconds timeout_;
  boost::asio::thread_pool pool_{1};
  AuditNotes notes_;
  bool sending_ = false; /**< notes are on their way, or about to be */
  bool failing_ = false; /**< as far as the log was told */
};

}  // namespace interlock
