/**
 * @file
 * The HTTP server: connections, limits, security headers, and who answers what.
 */
#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
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
#include "http/front_door.hpp"
#include "http/static_files.hpp"

namespace interlock::web {

/** Answers what comes in by its door from API, stream and files. */
class Server {
 public:
  /** Connections with a request at the same time, as far as the descriptors of the process go that far; the
   * oldest one whose request has not come to its end makes room for a newer one. */
  static constexpr std::size_t capacity = 256;
  /** Further ones while all those are at work. They get one answer each: the status its own, everything else
   * 503 OVERLOADED. Beyond these a connection is closed unanswered. */
  static constexpr std::size_t reserve = 16;
  /** Descriptors that are no connections: store, logs, link to the kernel, event loops. */
  static constexpr std::size_t own_descriptors = 64;

  /** @param door of the thread that keeps the door; everything else belongs to that of `executor` */
  Server(const boost::asio::any_io_executor& door, const boost::asio::any_io_executor& executor, Api& api,
         RealtimeChannel& channel, StaticFiles files);

  /** Where clients connect. */
  [[nodiscard]] FrontDoor& door() { return door_; }

  /** The port that was granted. */
  [[nodiscard]] std::uint16_t port() const { return door_.port(); }

  /** How many connections are granted here, as many at the door and as many between both, besides the
   * reserve: fewer than `capacity` in a process that may have few descriptors. */
  [[nodiscard]] std::size_t ceiling() const { return ceiling_; }

  /** Connections that are open. */
  [[nodiscard]] std::size_t connections() const;

  /** Connections whose request is being answered. */
  [[nodiscard]] std::size_t at_work() const;

 private:
  enum class Place { common, reserve };

  struct Connection {
    boost::beast::tcp_stream stream;
    boost::asio::ip::tcp protocol;
    Place place;
    std::string peer;                           /**< address and port of the client */
    bool known;                                 /**< somebody who was logged in has used it */
    std::chrono::steady_clock::time_point came; /**< its first request, no later than that */
    bool late;                                  /**< nobody expects that request to be carried out any more */
    boost::beast::flat_buffer buffer = {};
    bool waiting = true; /**< for the rest of a request, hence free to be closed */
    bool closed = false; /**< to make room for another */
  };

  boost::asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
  boost::asio::awaitable<std::uint64_t> body_limit_of(const Request& header, const std::string& peer);
  boost::asio::awaitable<void> serve_stream(Connection& connection, Request request);
  boost::asio::awaitable<AnyResponse> respond(const Request& request, Connection& connection);
  boost::asio::awaitable<Response> respond_api(const Request& request, Connection& connection);
  boost::asio::awaitable<bool> answer(Connection& connection, Response response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<bool> answer(Connection& connection, FileResponse response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<bool> answer(Connection& connection, AnyResponse response, bool head_only,
                                      bool keep_alive);
  boost::asio::awaitable<void> refuse(Connection& connection, Problem problem);
  boost::asio::awaitable<void> record(StopMade made);
  void admit(Guest guest);
  [[nodiscard]] bool is_late(std::chrono::steady_clock::time_point came) const;
  void give_back(Connection& connection);
  [[nodiscard]] std::size_t open_in(Place place) const;
  std::optional<Place> place_for_another();
  bool close_oldest_idle(Place place);

  boost::asio::any_io_executor executor_;
  Api& api_;
  const RealtimeChannel& channel_;
  StaticFiles files_;
  std::size_t ceiling_;
  std::list<std::shared_ptr<Connection>> connections_;
  std::atomic<std::size_t> arriving_{0}; /**< connections between the door and here */
  FrontDoor door_;
};

}  // namespace interlock::web
