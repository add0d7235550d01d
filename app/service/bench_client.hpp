/**
 * @file
 * Speaks to the simulated hardware's control socket (models/plant/README.md).
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/experimental/channel.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "system/utc_time.hpp"

namespace interlock {

/** Why the simulated hardware did not do what it was told. */
struct BenchError {
  /** Whether the bench answered at all. */
  enum class Kind { refused, unreachable };
  Kind kind = Kind::unreachable;
  std::string detail;
};

/** The bench's answer, or why there is none. */
using BenchReply = tl::expected<nlohmann::json, BenchError>;

/** One connection, made when needed; commands are carried out in the order in which they were given. */
class BenchClient {
 public:
  BenchClient(const boost::asio::any_io_executor& executor, std::string socket_path);

  /** Sends one command and waits for its answer, at most two seconds. */
  boost::asio::awaitable<BenchReply> command(nlohmann::json command);

  /** Since when the connection stands; nothing without one. */
  [[nodiscard]] const std::optional<UtcTime>& since() const { return since_; }

 private:
  using Turn = boost::asio::experimental::channel<void(boost::system::error_code)>;

  boost::asio::awaitable<BenchReply> exchange(const nlohmann::json& command);
  boost::asio::awaitable<boost::system::error_code> write_and_read(const std::string& line);
  BenchReply judge(const std::string& line, std::uint64_t id) const;

  boost::asio::any_io_executor executor_;
  std::string path_;
  boost::asio::local::stream_protocol::socket socket_;
  std::string received_;
  std::string answer_;
  Turn turn_;
  std::uint64_t last_id_ = 0;
  std::optional<UtcTime> since_;
};

}  // namespace interlock
