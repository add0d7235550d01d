#include "http/log_tail.hpp"
#include "http/message.hpp"
#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::int64_t default_lines = 20;
/** The audit keeps the text of each. */
constexpr std::size_t most_acknowledged = 100;
/** From which level on a line asks for somebody's attention. */
constexpr LogLevel alarming = LogLevel::warning;

tl::expected<std::vector<std::uint64_t>, Problem> sequences_in(const Request& request) {
  return parse_body(request).and_then(
      [](const json& body) -> tl::expected<std::vector<std::uint64_t>, Problem> {
        Fields fields(body, {"sequences"});
        fields.require({{"sequences", "1 to 100 numbers of lines"}});
        if (fields.problem()) {
          return fail(*fields.problem());
        }
        const json& numbers = *fields.value("sequences");
        if (!numbers.is_array() || numbers.empty() || numbers.size() > most_acknowledged) {
          return fail(
              invalid("sequences", "It is no array of 1 to 100 numbers.", "1 to 100 numbers of lines"));
        }
        std::vector<std::uint64_t> sequences;
        for (const json& number : numbers) {
          if (!number.is_number_unsigned()) {
            return fail(invalid("sequences[" + std::to_string(sequences.size()) + "]",
                                "It is no whole number.", "the number of a line, as GET /api/logs gives it"));
          }
          sequences.push_back(number.get<std::uint64_t>());
        }
        return sequences;
      });
}

/** What the audit keeps of a line: its number alone would say nothing after the app has ended. */
json kept_of(const LogLine& line) {
  constexpr std::size_t most_characters = 400;
  return {{"time", iso_8601(line.time)},
          {"level", name_of(line.level)},
          {"text", line.text.substr(0, most_characters)}};
}

std::vector<std::uint64_t> numbers_of(const std::vector<LogLine>& lines) {
  std::vector<std::uint64_t> numbers;
  for (const LogLine& line : lines) {
    numbers.push_back(line.sequence);
  }
  return numbers;
}

}  // namespace

LogRoutes::LogRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/logs", viewers,
             [this](const Call& call) -> Answering { co_return lines(call); });
  router.add(verb::put, "/api/logs", admins, [this](const Call& call) { return set_level(call); });
  router.add(verb::post, "/api/logs/acknowledge", engineers,
             [this](const Call& call) { return acknowledge(call); });
}

Success LogRoutes::answer(const std::vector<LogLine>& lines) const {
  json list = json::array();
  for (const LogLine& line : lines) {
    list.push_back(to_json(line));
  }
  return {.body = {{"level", name_of(context_.log.level())}, {"lines", std::move(list)}}};
}

Reply LogRoutes::lines(const Call& call) const {
  return known_query(call.request, {"lines", "level"}).and_then([this](const json& query) -> Reply {
    Fields fields(query, {"lines", "level"});
    const auto count = fields.integer("lines", 1, LogRing::capacity).value_or(default_lines);
    const auto level = log_level(fields.choice("level", log_level_names).value_or("debug"));
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return answer(
        context_.log.ring().newest(static_cast<std::size_t>(count), level.value_or(LogLevel::debug)));
  });
}

Answering LogRoutes::set_level(const Call& call) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  Fields fields(*body, {"level"});
  const auto name = fields.choice("level", log_level_names);
  fields.require({{"level", "debug, info, warning, error or critical"}});
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  json detail{{"setting", "log_level"}, {"old", name_of(context_.log.level())}, {"new", *name}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::setting, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  context_.log.set_level(log_level(*name).value_or(LogLevel::info));
  co_return answer({});
}

/** Those of the lines that nobody has acknowledged yet. */
tl::expected<std::vector<LogLine>, Problem> LogRoutes::unanswered(
    const std::vector<std::uint64_t>& sequences) const {
  std::vector<LogLine> lines;
  for (const std::uint64_t sequence : sequences) {
    auto line = context_.log.ring().find(sequence);
    if (!line) {
      return fail(not_found("log line " + std::to_string(sequence), "a line that GET /api/logs still gives"));
    }
    if (line->level < alarming) {
      return fail(invalid("sequences",
                          "Line " + std::to_string(sequence) + " is of level " +
                              std::string(name_of(line->level)) + ", which asks for no acknowledgement.",
                          "lines of level warning, error or critical"));
    }
    if (!line->acknowledged) {
      lines.push_back(std::move(*line));
    }
  }
  return lines;
}

Answering LogRoutes::acknowledge(const Call& call) const {
  const auto lines = sequences_in(call.request).and_then([this](const std::vector<std::uint64_t>& sequences) {
    return unanswered(sequences);
  });
  if (!lines) {
    co_return fail(lines.error());
  }
  if (lines->empty()) {
    co_return answer({});
  }
  json kept = json::array();
  for (const LogLine& line : *lines) {
    kept.push_back(kept_of(line));
  }
  json detail{{"lines", std::move(kept)}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::acknowledgement, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  const std::vector<LogLine> changed =
      context_.log.ring().acknowledge(numbers_of(*lines), {call.caller.user, context_.clock()});
  for (const LogLine& line : changed) {
    context_.publish(log_message(line));
  }
  co_return answer(changed);
}

}  // namespace interlock::web
