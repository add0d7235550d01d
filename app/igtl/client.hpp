/**
 * @file
 * A program at the other end: connects to one that listens, sends, and waits for what comes.
 *
 * It blocks, each time until a deadline at most. For the command line; the app's own connections are the
 * server's (igtl_server.hpp).
 */
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "igtl/frame.hpp"
#include "igtl/message.hpp"

namespace interlock::igtl {

class Client {
 public:
  /** When a call gives up. */
  using Deadline = std::chrono::steady_clock::time_point;

  Client() : socket_(context_) {}

  /** `host` is a name or an address. The error says what the network says. */
  tl::expected<void, std::string> connect(const std::string& host, std::uint16_t port, Deadline deadline);

  /** Sends one message, or says why it did not go. */
  tl::expected<void, std::string> send(const std::string& device, const Body& body, Deadline deadline);

  /** The next message that is understood; none when the deadline comes first. An error: the connection ended
   * or is of no use. */
  tl::expected<std::optional<Message>, std::string> receive(Deadline deadline);

 private:
  bool run_until(const std::optional<boost::system::error_code>& done, Deadline deadline);
  tl::expected<bool, std::string> read_some(Deadline deadline);
  tl::expected<void, std::string> take(Bytes input);

  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket socket_;
  FrameReader reader_;
  std::deque<Message> messages_;
};

}  // namespace interlock::igtl
