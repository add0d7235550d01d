#include "http/log_tail.hpp"

#include <boost/asio/post.hpp>

namespace interlock::web {

using nlohmann::json;

json to_json(const LogLine& line) {
  return {{"sequence", line.sequence},
          {"time", iso_8601(line.time)},
          {"level", name_of(line.level)},
          {"text", line.text},
          {"repeated", line.repeated}};
}

json log_message(const LogLine& line) {
  json message = to_json(line);
  message["type"] = "log";
  return message;
}

LogTail::LogTail(boost::asio::any_io_executor executor, LogRing& ring, Broadcaster& stream)
    : executor_(std::move(executor)), ring_(ring), stream_(stream), sent_(ring.last()) {
  ring_.on_line([this] { wake(); });
}

LogTail::~LogTail() {
  ring_.on_line([] {});
}

void LogTail::wake() {
  if (!woken_.exchange(true)) {
    boost::asio::post(executor_, [this] { send(); });
  }
}

void LogTail::send() {
  woken_ = false;
  for (const LogLine& line : ring_.after(sent_)) {
    sent_ = line.sequence;
    stream_.send_text(log_message(line));
  }
}

}  // namespace interlock::web
