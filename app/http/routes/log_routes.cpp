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
}  // namespace

LogRoutes::LogRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/logs", viewers,
             [this](const Call& call) -> Answering { co_return lines(call); });
  router.add(verb::put, "/api/logs", admins, [this](const Call& call) { return set_level(call); });
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

}  // namespace interlock::web
