#include "cli/http_get.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

namespace interlock::cli {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr unsigned http_version = 11;

/** The three steps of one exchange, each begun by the one before. */
class Exchange {
 public:
  Exchange(asio::io_context& context, const std::string& target, std::chrono::seconds timeout)
      : stream_(context), request_(http::verb::get, target, http_version) {
    request_.set(http::field::host, "127.0.0.1");
    stream_.expires_after(timeout);
  }

  void begin(const asio::ip::tcp::endpoint& endpoint) {
    stream_.async_connect(endpoint, [this](beast::error_code error) {
      if (!failed_with(error)) {
        ask();
      }
    });
  }

  [[nodiscard]] beast::error_code error() const { return error_; }
  [[nodiscard]] HttpAnswer answer() const { return {response_.result_int(), response_.body()}; }

 private:
  void ask() {
    http::async_write(stream_, request_, [this](beast::error_code error, std::size_t) {
      if (!failed_with(error)) {
        http::async_read(stream_, buffer_, response_,
                         [this](beast::error_code read_error, std::size_t) { error_ = read_error; });
      }
    });
  }

  bool failed_with(beast::error_code error) {
    error_ = error;
    return error.failed();
  }

  beast::tcp_stream stream_;
  http::request<http::empty_body> request_;
  beast::flat_buffer buffer_;
  http::response<http::string_body> response_;
  beast::error_code error_;
};

}  // namespace

Result<HttpAnswer> http_get(std::uint16_t port, const std::string& target, std::chrono::seconds timeout) {
  asio::io_context context;
  Exchange exchange(context, target, timeout);
  exchange.begin({asio::ip::address_v4::loopback(), port});
  context.run();
  if (exchange.error()) {
    return failed(ExitCode::no_answer, "no answer from http://127.0.0.1:" + std::to_string(port) + target +
                                           ": " + exchange.error().message() +
                                           "; start one with interlock run, or name its --port");
  }
  return exchange.answer();
}

}  // namespace interlock::cli
