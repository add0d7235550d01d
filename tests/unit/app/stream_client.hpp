/**
 * @file
 * A console at the other end of the server's stream. What a WebSocket is made of is compiled once, not in
 * every test.
 */
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace interlock::test {

struct StreamMessage {
  bool text = false; /**< else binary: a state */
  std::string data;
};

class StreamClient {
 public:
  explicit StreamClient(boost::asio::ip::tcp::socket connected);
  StreamClient(StreamClient&&) noexcept;
  StreamClient& operator=(StreamClient&&) noexcept;
  ~StreamClient();

  /** Asks for the stream, with a cookie and an origin unless they are empty; the server's status: 101 when
   * open. */
  unsigned open(const std::string& host, const std::string& cookie, const std::string& origin = "");

  /** The next message of any kind; none when the server has closed the stream. */
  std::optional<StreamMessage> next();

  /** The next text message; fails the test when the stream is closed. */
  nlohmann::json next_text();

  /** The next text message of that type. */
  nlohmann::json next_text(const std::string& type);

  /** The code with which the server closes the stream; what comes before is not looked at. */
  unsigned close_code();

  void send(const std::string& text);
  void close();
  [[nodiscard]] std::uint16_t local_port() const;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace interlock::test
