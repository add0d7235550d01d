#include <limits>

#include "http/message.hpp"
#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/runs.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::int64_t default_runs = 50;
constexpr std::int64_t most_runs = 500;
constexpr std::int64_t largest_retention = 100'000;

constexpr std::initializer_list<const char*> filter_fields{"case",  "outcome", "kind", "axis",
                                                           "since", "before",  "count"};

tl::expected<RunFilter, Problem> run_filter_of(const json& query) {
  Fields fields(query, filter_fields);
  constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  RunFilter filter{
      .case_number = fields.integer("case", 0, largest),
      .outcome = fields.text("outcome"),
      .kind = fields.text("kind"),
      .axis = fields.text("axis"),
      .since = std::nullopt,
      .before = fields.integer("before", 1, largest),
      .count = static_cast<std::size_t>(fields.integer("count", 1, most_runs).value_or(default_runs))};
  if (const auto since = fields.text("since")) {
    filter.since = parse_iso_8601(*since);
    if (!filter.since) {
      fields.reject("since", *since, "a time such as 2024-05-01T12:34:56.789Z");
    }
  }
  return fields.problem() ? tl::expected<RunFilter, Problem>(fail(*fields.problem())) : filter;
}

/** The number in the path; one that is none is of no run. */
std::int64_t run_in(const Call& call) { return number_in(call.parameters[0]).value_or(0); }

Answering run_reply(CaseAnswer answering) {
  auto answer = co_await std::move(answering);
  co_return std::move(answer).map([](json body) { return Success{.body = std::move(body)}; });
}

}  // namespace

RunRoutes::RunRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/runs", viewers, [this](const Call& call) { return list(call); });
  router.add(verb::put, "/api/runs/retention", admins, [this](const Call& call) { return retain(call); });
  router.add(verb::get, "/api/runs/{id}", viewers,
             [this](const Call& call) { return run_reply(show_run(context_, run_in(call))); });
  router.add(verb::get, "/api/runs/{id}/samples", viewers,
             [this](const Call& call) { return run_reply(samples_of_run(context_, run_in(call))); });
  router.add(verb::get, "/api/runs/{id}/csv", viewers, [this](const Call& call) { return csv(call); });
  router.add(verb::put, "/api/runs/{id}/note", engineers,
             [this](const Call& call) { return annotate(call); });
}

Answering RunRoutes::list(const Call& call) const {
  auto filter = known_query(call.request, filter_fields).and_then(run_filter_of);
  if (!filter) {
    co_return fail(filter.error());
  }
  co_return co_await run_reply(list_runs(context_, std::move(*filter)));
}

Answering RunRoutes::csv(const Call& call) const {
  auto run = co_await show_run(context_, run_in(call));
  if (!run) {
    co_return fail(run.error());
  }
  auto samples = co_await samples_of_run(context_, run_in(call));
  if (!samples) {
    co_return fail(samples.error());
  }
  auto write = [run = std::move(*run), samples = std::move(*samples)] { return samples_csv(run, samples); };
  auto text = co_await context_.work.run(std::move(write));
  co_return std::move(text).map(
      [](std::string table) { return Success{.body = std::move(table), .text_type = "text/csv"}; });
}

Answering RunRoutes::annotate(const Call& call) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  Fields fields(*body, {"text"});
  fields.require({{"text", "a text, which may be empty"}});
  std::string note = fields.text("text").value_or("");
  if (!note.empty() && !fields.problem()) {
    note = fields.line("text", 1000).value_or("");
  }
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  co_return co_await run_reply(annotate_run(context_, call.caller, run_in(call), std::move(note)));
}

Answering RunRoutes::retain(const Call& call) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  Fields fields(*body, {"count", "days"});
  const RunRetention retention{fields.integer("count", RunRetention::always, largest_retention).value_or(0),
                               fields.integer("days", 1, largest_retention).value_or(0)};
  fields.require({{"count", "how many of the newest runs stay"}, {"days", "for how many days a run stays"}});
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  co_return co_await run_reply(set_run_retention(context_, call.caller, retention));
}

}  // namespace interlock::web
