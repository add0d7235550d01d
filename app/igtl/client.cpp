#include "igtl/client.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "igtl/codec.hpp"

namespace interlock::igtl {
namespace {

using ErrorCode = boost::system::error_code;

constexpr std::size_t most_bytes = 16u * 1024u;
constexpr const char* no_time = "no answer in time";

}  // namespace

/** Lets the operation run that tells its end by `done`; one that does not end in time is cancelled. */
bool Client::run_until(const std::optional<ErrorCode>& done, Deadline deadline) {
  context_.restart();
  while (!done && context_.run_one_until(deadline) != 0) {
  }
  if (done) {
    return true;
  }
  ErrorCode ignored;
  socket_.cancel(ignored);
  context_.restart();
  context_.run();
  return false;
}

tl::expected<void, std::string> Client::connect(const std::string& host, std::uint16_t port,
                                                Deadline deadline) {
  ErrorCode unknown;
  const auto places = boost::asio::ip::tcp::resolver(context_).resolve(host, std::to_string(port), unknown);
  if (unknown) {
    return tl::unexpected(unknown.message());
  }
  std::optional<ErrorCode> done;
  boost::asio::async_connect(socket_, places,
                             [&](ErrorCode error, const boost::asio::ip::tcp::endpoint&) { done = error; });
  if (!run_until(done, deadline)) {
    return tl::unexpected(no_time);
  }
  if (done->failed()) {
    return tl::unexpected(done->message());
  }
  socket_.set_option(boost::asio::ip::tcp::no_delay(true), unknown);
  return {};
}

tl::expected<void, std::string> Client::send(const std::string& device, const Body& body, Deadline deadline) {
  const ByteVector bytes = write_frame(1, type_of(body), device, 0, encode(body));
  std::optional<ErrorCode> done;
  boost::asio::async_write(socket_, boost::asio::buffer(bytes),
                           [&](ErrorCode error, std::size_t) { done = error; });
  if (!run_until(done, deadline)) {
    return tl::unexpected(no_time);
  }
  return done->failed() ? tl::unexpected(done->message()) : tl::expected<void, std::string>();
}

tl::expected<void, std::string> Client::take(Bytes input) {
  while (!input.empty()) {
    Arrival arrival = reader_.take(input);
    if (const auto* broken = std::get_if<Broken>(&arrival)) {
      return tl::unexpected(std::string(fault_text(broken->fault)));
    }
    if (auto* frame = std::get_if<Frame>(&arrival)) {
      if (auto message = decode(std::move(*frame))) {
        messages_.push_back(std::move(*message));
      }
    }
  }
  return {};
}

/** False when nothing came in time. */
tl::expected<bool, std::string> Client::read_some(Deadline deadline) {
  std::array<std::uint8_t, most_bytes> chunk{};
  std::optional<ErrorCode> done;
  std::size_t count = 0;
  socket_.async_read_some(boost::asio::buffer(chunk), [&](ErrorCode error, std::size_t bytes) {
    done = error;
    count = bytes;
  });
  if (!run_until(done, deadline)) {
    return false;
  }
  if (done->failed()) {
    return tl::unexpected(done->message());
  }
  return take(Bytes(chunk).first(count)).map([] { return true; });
}

tl::expected<std::optional<Message>, std::string> Client::receive(Deadline deadline) {
  while (messages_.empty()) {
    const auto came = read_some(deadline);
    if (!came) {
      return tl::unexpected(came.error());
    }
    if (!*came) {
      return std::nullopt;
    }
  }
  Message message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

}  // namespace interlock::igtl
