/**
 * @file
 * Looks for STOPs in what programs have sent and nobody has read yet, in a thread of its own: so that no STOP
 * by OpenIGTLink waits for what came before it, or for the thread that reads messages.
 */
#pragma once

#include <array>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "igtl/wire.hpp"

namespace interlock::igtl {

/** How many whole messages that ask for a STOP, of whatever dialect, begin anywhere in these bytes. */
std::size_t stops_in(Bytes bytes);

/** Reads nothing away: whoever reads a connection finds each STOP that was seen here once more. */
class StopScout {
 public:
  /** For so long whoever reads the connection may do so first, as it does unless it is held up. */
  static constexpr std::chrono::milliseconds time_to_read{5};
  /** Bytes that are looked at, of those that wait. */
  static constexpr std::size_t reach = 65536;

  /** @param stop called in the thread of `executor` for each STOP that was not seen before; must not wait */
  StopScout(const boost::asio::any_io_executor& executor, std::function<void()> stop);

  /** Looks at that socket until it ends or `connection` does; without a descriptor to spare, not at all. For
   * any thread. */
  void watch(int socket, std::weak_ptr<const void> connection);

 private:
  boost::asio::awaitable<void> look(boost::asio::posix::stream_descriptor socket,
                                    std::weak_ptr<const void> connection);

  boost::asio::any_io_executor executor_;
  std::function<void()> stop_;
  std::array<std::uint8_t, reach> unread_{}; /**< of the socket that is looked at */
};

}  // namespace interlock::igtl
