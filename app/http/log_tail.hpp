/**
 * @file
 * Each line of the log on its way to the stream's clients.
 */
#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "http/broadcaster.hpp"
#include "log/log_ring.hpp"

namespace interlock::web {

/** Schema `LogLine` of spec/openapi.yaml. */
nlohmann::json to_json(const LogLine& line);

/** The line as the stream tells it. */
nlohmann::json log_message(const LogLine& line);

/** Whoever writes a line only wakes the network thread, which reads it from the ring and sends it. */
class LogTail {
 public:
  /** `executor` is of the network thread; ring and stream must outlive the tail. */
  LogTail(boost::asio::any_io_executor executor, LogRing& ring, Broadcaster& stream);
  ~LogTail();

  LogTail(const LogTail&) = delete;
  LogTail& operator=(const LogTail&) = delete;

 private:
  void wake();
  void send();

  boost::asio::any_io_executor executor_;
  LogRing& ring_;
  Broadcaster& stream_;
  std::uint64_t sent_;
  std::atomic<bool> woken_{false};
};

}  // namespace interlock::web
