/**
 * @file
 * How the app starts work that goes on by itself.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <utility>

namespace interlock {

/**
 * Starts work that nobody waits for. An exception that leaves it leaves `run` of its io_context: what nobody
 * expected ends the process with its cause, which is then started anew, instead of a part of it in silence.
 */
template <typename Executor>
void launch(const Executor& executor, boost::asio::awaitable<void> work) {
  boost::asio::co_spawn(executor, std::move(work), [](const std::exception_ptr& thrown) {
    if (thrown) {
      std::rethrow_exception(thrown);
    }
  });
}

}  // namespace interlock
