#include "service/bench_client.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>

#include "system/as_result.hpp"

namespace interlock {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using nlohmann::json;

constexpr std::chrono::seconds answer_timeout{2};
constexpr std::size_t longest_answer = 16u << 20u;

tl::unexpected<BenchError> unreachable(const std::string& detail) {
  return tl::make_unexpected(BenchError{BenchError::Kind::unreachable, detail});
}

}  // namespace

BenchClient::BenchClient(const asio::any_io_executor& executor, std::string socket_path)
    : executor_(executor), path_(std::move(socket_path)), socket_(executor), turn_(executor, 1) {}

asio::awaitable<BenchReply> BenchClient::command(json command) {
  const auto [no_turn] = co_await turn_.async_send(error_code{}, as_result);
  if (no_turn) {
    co_return unreachable("The bench is closing.");
  }
  BenchReply reply = co_await exchange(command);
  turn_.try_receive([](error_code) {});
  co_return reply;
}

asio::awaitable<BenchReply> BenchClient::exchange(const json& command) {
  const std::uint64_t id = ++last_id_;
  json numbered = command;
  numbered["id"] = id;
  const std::string line = numbered.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  const error_code error = co_await write_and_read(line);
  if (error) {
    error_code ignored;
    socket_.close(ignored);
    since_.reset();
    received_.clear();
    co_return unreachable("The simulated hardware at " + path_ + " does not answer: " + error.message() +
                          ".");
  }
  co_return judge(answer_, id);
}

asio::awaitable<error_code> BenchClient::write_and_read(const std::string& line) {
  if (!socket_.is_open()) {
    const auto [error] =
        co_await socket_.async_connect(asio::local::stream_protocol::endpoint(path_), as_result);
    if (error) {
      co_return error;
    }
    since_ = std::chrono::system_clock::now();
  }
  asio::steady_timer limit(executor_, answer_timeout);
  limit.async_wait([this](error_code cancelled) {
    if (!cancelled) {
      error_code ignored;
      socket_.cancel(ignored);
    }
  });
  const auto [write_error, written] = co_await asio::async_write(socket_, asio::buffer(line), as_result);
  if (write_error) {
    co_return write_error;
  }
  const auto [read_error, length] = co_await asio::async_read_until(
      socket_, asio::dynamic_buffer(received_, longest_answer), '\n', as_result);
  if (read_error) {
    co_return read_error;
  }
  answer_ = received_.substr(0, length);
  received_.erase(0, length);
  co_return error_code{};
}

BenchReply BenchClient::judge(const std::string& line, std::uint64_t id) const {
  json answer = json::parse(line, nullptr, false);
  if (!answer.is_object() || answer.value("id", json()) != json(id)) {
    return unreachable("The simulated hardware at " + path_ + " answered out of turn.");
  }
  answer.erase("id");
  if (answer.value("ok", json()) != json(true)) {
    const json reason = answer.value("error", json());
    return tl::make_unexpected(BenchError{BenchError::Kind::refused,
                                          reason.is_string() ? reason.get<std::string>() : answer.dump()});
  }
  return answer;
}

}  // namespace interlock
