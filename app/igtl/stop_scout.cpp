#include "igtl/stop_scout.hpp"

#include <fcntl.h>
#include <sys/socket.h>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <utility>

#include "igtl/codec.hpp"
#include "igtl/dialect.hpp"
#include "igtl/frame.hpp"
#include "system/as_result.hpp"
#include "system/file_descriptor.hpp"
#include "system/launch.hpp"

namespace interlock::igtl {
namespace {

namespace asio = boost::asio;

/** Of a message of which the header is there: by its name, or once its text is there as well. */
bool begins_with_stop(Bytes bytes) {
  const auto header = read_header(bytes.first(header_bytes));
  if (!header) {
    return false;
  }
  if (stop_name(header->device)) {
    return true;
  }
  if (!may_ask_to_stop(header->device)) {
    return false;
  }
  FrameReader reader;
  Arrival arrival = reader.take(bytes);
  auto* frame = std::get_if<Frame>(&arrival);
  const auto message = frame != nullptr ? std::optional(decode(std::move(*frame))) : std::nullopt;
  return message && *message && asks_to_stop(**message);
}

}  // namespace

std::size_t stops_in(Bytes bytes) {
  std::size_t stops = 0;
  for (; bytes.size() >= header_bytes; bytes = bytes.subspan(1)) {
    const bool may_be_header = bytes[0] == 0 && (bytes[1] == 1 || bytes[1] == 2);
    stops += may_be_header && begins_with_stop(bytes) ? 1u : 0u;
  }
  return stops;
}

StopScout::StopScout(const asio::any_io_executor& executor, std::function<void()> stop)
    : executor_(executor), stop_(std::move(stop)) {}

void StopScout::watch(int socket, std::weak_ptr<const void> connection) {
  FileDescriptor own(::fcntl(socket, F_DUPFD_CLOEXEC, 0));
  if (own.get() < 0) {
    return;
  }
  asio::post(executor_, [this, own = std::move(own), connection = std::move(connection)]() mutable {
    launch(executor_, look(asio::posix::stream_descriptor(executor_, own.release()), std::move(connection)));
  });
}

asio::awaitable<void> StopScout::look(asio::posix::stream_descriptor socket,
                                      std::weak_ptr<const void> connection) {
  asio::steady_timer pause(executor_);
  std::size_t seen = 0;
  for (;;) {
    const auto [ended] = co_await socket.async_wait(asio::posix::stream_descriptor::wait_read, as_result);
    if (ended) {
      co_return;
    }
    pause.expires_after(time_to_read);
    const auto [cancelled] = co_await pause.async_wait(as_result);
    if (cancelled || connection.expired()) {
      co_return;
    }
    const ssize_t count =
        ::recv(socket.native_handle(), unread_.data(), unread_.size(), MSG_PEEK | MSG_DONTWAIT);
    if (count == 0) {
      co_return;
    }
    const std::size_t stops =
        count < 0 ? 0 : stops_in(Bytes(unread_.data(), static_cast<std::size_t>(count)));
    if (stops > seen) {
      stop_();
    }
    seen = stops;
  }
}

}  // namespace interlock::igtl
