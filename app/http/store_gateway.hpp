/**
 * @file
 * The way from the network thread to the store, which has a thread of its own: the network never waits for
 * the disk.
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <utility>
#include <vector>

#include "http/message.hpp"
#include "store/audit.hpp"
#include "store/store.hpp"

namespace interlock::web {

/** 422 INVALID, 404, 409 EXISTS or LAST_ADMIN, or 503 STORE when the file fails. */
Problem problem_of(const StoreError& error);

class StoreGateway {
 public:
  /** Notes that wait while the store fails; beyond them the newest are lost, which the log says. */
  static constexpr std::size_t most_notes = 4096;

  /** `network` is the executor of the thread that uses the gateway; `store` must outlive it. */
  StoreGateway(boost::asio::any_io_executor network, Store& store);

  /** Writes what was noted, as far as the store takes it. */
  ~StoreGateway();

  StoreGateway(const StoreGateway&) = delete;
  StoreGateway& operator=(const StoreGateway&) = delete;

  /**
   * Runs `work(Store&)`, which returns a `Stored<...>`, in the store's thread, after everything that was
   * asked for or noted before. Errors and exceptions become the problem of `problem_of`.
   *
   * Pass a named `work` by `std::move`: GCC 12 destroys twice what a temporary inside `co_await` captured.
   */
  template <typename Work>
  auto run(Work work) -> boost::asio::awaitable<
      tl::expected<typename std::invoke_result_t<Work, Store&>::value_type, Problem>> {
    send_notes();
    auto result =
        co_await boost::asio::co_spawn(pool_, in_store(store_, std::move(work)), boost::asio::use_awaitable);
    watch(result ? nullptr : &result.error());
    co_return std::move(result).map_error(problem_of);
  }

  /** Writes a record that must be on the disk before anything else happens. */
  boost::asio::awaitable<tl::expected<void, Problem>> record(AuditEntry entry);

  /** Writes a record soon, and those that are noted at about the same time with it. Nobody waits for it. */
  void note(AuditEntry entry);

 private:
  template <typename Work>
  static auto in_store(Store& store, Work work)
      -> boost::asio::awaitable<std::invoke_result_t<Work, Store&>> {
    try {
      co_return work(store);
    } catch (const std::exception& exception) {
      co_return tl::make_unexpected(StoreError{StoreError::Kind::unavailable, exception.what(), "", "", ""});
    }
  }

  void send_notes();
  void take_back(std::vector<AuditEntry> notes);
  void watch(const StoreError* error);

  boost::asio::any_io_executor network_;
  Store& store_;
  boost::asio::thread_pool pool_{1};
  std::vector<AuditEntry> notes_;
  bool sending_soon_ = false;
  bool failing_ = false; /**< as far as the log was told */
};

}  // namespace interlock::web
