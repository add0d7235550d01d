/**
 * @file
 * Threads for what takes long: hashing a password (a tenth of a second and 64 MiB), reading a trajectory,
 * planning what people want to see.
 * Neither the network nor the store waits for them.
 */
#pragma once

#include <sys/resource.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstddef>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "service/reply.hpp"

namespace interlock {

/** Belongs to the network thread. */
class WorkPool {
 public:
  static constexpr std::size_t threads = 2;
  /** Pieces of work that are done or wait; one more is refused. */
  static constexpr std::size_t capacity = 64;

  /**
   * What `work()` gives, run in one of the threads in the order of asking. 503 OVERLOADED when too many wait,
   * or when there is no memory for it.
   *
   * Pass a named `work` by `std::move`: GCC 12 destroys twice what a temporary inside `co_await` captured.
   */
  template <typename Work>
  auto run(Work work) -> boost::asio::awaitable<tl::expected<std::invoke_result_t<Work>, Problem>> {
    if (asked_ >= capacity) {
      co_return tl::make_unexpected(full());
    }
    const Place place(asked_);
    auto result = co_await boost::asio::co_spawn(pool_, in_pool(std::move(work)), boost::asio::use_awaitable);
    if (!result) {
      co_return tl::make_unexpected(no_memory());
    }
    co_return std::move(*result);
  }

 private:
  /** One of the pieces that are asked for, for as long as it lives. */
  class Place {
   public:
    explicit Place(std::size_t& asked) : asked_(asked) { ++asked_; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() { --asked_; }

   private:
    std::size_t& asked_;
  };

  /** Nothing when there is no memory. */
  template <typename Work>
  static auto in_pool(Work work) -> boost::asio::awaitable<std::optional<std::invoke_result_t<Work>>> {
    // In turn with the rest of the machine: nobody's STOP waits for this (main.cpp).
    (void)setpriority(PRIO_PROCESS, 0, 0);
    try {
      co_return std::optional(work());
    } catch (const std::bad_alloc&) {
      co_return std::nullopt;
    }
  }

  static Problem no_memory() {
    return {.status = Status::service_unavailable,
            .code = "OVERLOADED",
            .detail = "There is not enough memory.",
            .next_step = "Try again in a moment, or end other programs.",
            .headers = {{"Retry-After", "1"}}};
  }

  static Problem full() {
    return {.status = Status::service_unavailable,
            .code = "OVERLOADED",
            .detail = "Too many passwords, trajectories and plans wait to be looked at.",
            .next_step = "Try again in a moment.",
            .headers = {{"Retry-After", "1"}}};
  }

  std::size_t asked_ = 0;
  boost::asio::thread_pool pool_{threads};
};

}  // namespace interlock
