/**
 * @file
 * Where connections come in and wait for a request: in a thread of its own, which answers STOP by itself. So
 * no STOP waits for whatever the thread behind it does, on a fresh connection or on one that has had its
 * answer.
 */
#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "http/message.hpp"
#include "http/same_origin.hpp"
#include "motion/realtime_channel.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::web {

/** Where to listen. */
struct Listen {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080; /**< 0: any free one */
  ReverseProxy proxy = {};
};

/** A connection on its way from one thread to another. */
struct Guest {
  FileDescriptor socket;
  boost::asio::ip::tcp protocol = boost::asio::ip::tcp::v4();
  std::string peer;                           /**< address and port of the client */
  bool known = false;                         /**< somebody who was logged in has used it */
  std::chrono::steady_clock::time_point came; /**< its next request, no later than that */
};

/** The socket behind a descriptor, for another thread than before; nothing when the system refuses. */
std::optional<boost::asio::ip::tcp::socket> socket_of(FileDescriptor descriptor,
                                                      boost::asio::ip::tcp protocol,
                                                      const boost::asio::any_io_executor& executor);

/** A STOP that was sent to the kernel, for the records. */
struct StopMade {
  Request header; /**< with the cookies that tell by whom */
  std::string peer;
  std::uint32_t unrecorded = 0; /**< STOPs before it that came too fast to be recorded one by one */
};

/** Everything but `come_back`, `recorded` and `beats` belongs to the door's thread. */
class FrontDoor {
 public:
  /** STOPs whose records are on their way; further ones are counted. */
  static constexpr std::uint32_t most_unrecorded = 64;

  /**
   * @param capacity how many connections may wait for a request; one more, and that which has waited longest is
   * closed, of strangers first, and one on which a request has begun last
   * @param let_in takes a connection on which a request other than STOP begins
   * @param record takes a STOP; `recorded` is to be called once that is done
   *
   * Both are called in the door's thread and must not wait.
   */
  FrontDoor(const boost::asio::any_io_executor& executor, RealtimeChannel& channel, std::size_t capacity,
            std::function<void(Guest)> let_in, std::function<void(StopMade)> record);

  /** Starts to listen; the error names address, port and what to do. Only loopback addresses are granted. */
  tl::expected<void, std::string> listen(const Listen& where);

  /** The port that was granted. */
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  /** By which clients on other machines come, as `listen` was told. */
  [[nodiscard]] const ReverseProxy& proxy() const { return proxy_; }

  /** Accepts connections; ends with the io_context. */
  boost::asio::awaitable<void> accept();

  /** Shows that the door is kept, and closes connections that have waited for too long; ends with the
   * io_context. */
  boost::asio::awaitable<void> heartbeat();

  /** Tells of the kernel's answers; ends with the io_context. */
  boost::asio::awaitable<void> listen_to_control();

  /** A connection that had its answer waits for its next request. For any thread. */
  void come_back(Guest guest);

  /** How many connections wait for a request. */
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

  /** A STOP has been recorded. For any thread. */
  void recorded() { unrecorded_.fetch_sub(1, std::memory_order_relaxed); }

 private:
  struct Waiting {
    boost::asio::ip::tcp::socket socket;
    boost::asio::ip::tcp protocol;
    std::string peer;
    bool known = false;
    std::chrono::steady_clock::time_point since;
  };
  struct Waiter {
    std::optional<StopAnswer> answer;
    boost::asio::steady_timer timer;
  };

  void wait_for_request(Waiting waiting);
  bool make_room(std::chrono::milliseconds waited);
  void look_at(Waiting waiting);
  [[nodiscard]] std::chrono::steady_clock::time_point came() const;
  boost::asio::awaitable<void> serve_stop(Waiting waiting);
  boost::asio::awaitable<Response> stop(Request header, std::string peer);
  boost::asio::awaitable<void> survive(const boost::system::error_code& error);

  boost::asio::any_io_executor executor_;
  RealtimeChannel& channel_;
  std::size_t capacity_;
  std::function<void(Guest)> let_in_;
  std::function<void(StopMade)> record_;
  ReverseProxy proxy_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::posix::stream_descriptor wake_;
  std::map<std::uint64_t, Waiting> waiting_; /**< by a number that rises: oldest first */
  std::uint64_t last_waiting_ = 0;
  std::chrono::steady_clock::time_point beat_at_ = std::chrono::steady_clock::time_point::max();
  std::chrono::steady_clock::time_point pause_from_; /**< of this thread, the last one that was long */
  std::chrono::steady_clock::time_point pause_felt_until_;
  std::multimap<std::uint32_t, Waiter*> waiters_; /**< by the number of their STOP */
  std::atomic<std::uint32_t> unrecorded_{0};
  std::uint32_t passed_over_ = 0; /**< STOPs that were not recorded one by one */
};

}  // namespace interlock::web
