/**
 * @file
 * The HTTP server: connections, limits, security headers, and who answers what.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "http/api.hpp"
#include "http/static_files.hpp"

namespace interlock::web {

/** Where to listen. */
struct Listen {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080; /**< 0: any free one */
};

/** Accepts connections and answers them from API, stream and files. */
class Server {
 public:
  /** Connections at the same time, as far as the descriptors of the process go that far; the oldest one that
   * waits for a request makes room for a newer one. */
  static constexpr std::size_t capacity = 256;
  /** Further ones while all those are at work. They get one answer each: STOP and status theirs, everything
   * else 503 OVERLOADED. Beyond these a connection is closed unanswered. */
  static constexpr std::size_t reserve = 16;
  /** Descriptors that are no connections: store, logs, link to the kernel, event loop. */
  static constexpr std::size_t own_descriptors = 64;
  static constexpr std::uint64_t longest_body = 64u * 1024u;
  /** Of a trajectory that somebody uploads who may load one. */
  static constexpr std::uint64_t longest_trajectory = 16u * 1024u * 1024u;
  static constexpr std::uint32_t longest_header = 16u * 1024u;

  Server(const boost::asio::any_io_executor& executor, Api& api, StaticFiles files)
      : acceptor_(executor), api_(api), files_(std::move(files)) {}

  /** Starts to listen; the error names address, port and what to do. Only loopback addresses are granted. */
  tl::expected<void, std::string> listen(const Listen& where);

  /** The port that was granted. */
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  /** How many connections are granted, besides the reserve: fewer than `capacity` in a process that may have
   * few descriptors. */
  [[nodiscard]] std::size_t ceiling() const { return ceiling_; }

  /** Connections that are open. */
  [[nodiscard]] std::size_t connections() const;

  /** Connections whose request is being answered. */
  [[nodiscard]] std::size_t at_work() const;

  /** Accepts and serves connections; ends with the io_context. */
  boost::asio::awaitable<void> accept();

 private:
  enum class Place { common, reserve };

  struct Connection {
    Connection(boost::beast::tcp_stream connected, Place granted);
    boost::beast::tcp_stream stream;
    boost::beast::flat_buffer buffer;
    Place place;
    std::string peer;    /**< address and port of the client */
    bool waiting = true; /**< for a request, hence free to be closed */
    bool closed = false; /**< to make room for another */
  };

  boost::asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
  boost::asio::awaitable<std::uint64_t> body_limit_of(const Request& header, const std::string& peer);
  boost::asio::awaitable<void> serve_stream(Connection& connection, Request request);
  boost::asio::awaitable<AnyResponse> respond(const Request& request, const Connection& connection);
  boost::asio::awaitable<Response> respond_api(const Request& request, const std::string& peer);
  boost::asio::awaitable<bool> answer(Connection& connection, Response response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<bool> answer(Connection& connection, FileResponse response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<bool> answer(Connection& connection, AnyResponse response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<void> refuse(Connection& connection, const boost::beast::error_code& error);
  boost::asio::awaitable<void> survive(const boost::beast::error_code& error);
  void admit(boost::asio::ip::tcp::socket socket, Place place);
  [[nodiscard]] std::size_t open_in(Place place) const;
  std::optional<Place> place_for_another();
  bool close_oldest_idle(Place place);

  boost::asio::ip::tcp::acceptor acceptor_;
  Api& api_;
  StaticFiles files_;
  std::size_t ceiling_ = capacity;
  std::list<std::shared_ptr<Connection>> connections_;
};

}  // namespace interlock::web
