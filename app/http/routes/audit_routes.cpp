#include <algorithm>
#include <limits>
#include <memory>

#include "http/message.hpp"
#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "store/audit_verdict.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using nlohmann::json;

constexpr std::int64_t default_records = 100;
constexpr std::int64_t most_records = 1000;
constexpr std::initializer_list<const char*> filter_fields{"records", "before", "kind",
                                                           "actor",   "text",   "since"};

bool is_hash(const std::string& text) {
  return text.size() == 64 && std::ranges::all_of(text, [](char each) {
           return (each >= '0' && each <= '9') || (each >= 'a' && each <= 'f');
         });
}

/** Schema `AuditCheck`. */
json check_json(const AuditCheck& check, ComparedHeads heads, UtcTime now) {
  const auto result = check.result();
  json body{{"checked", iso_8601(now)}, {"sound", result.has_value()}, {"proven", false},
            {"head", nullptr},          {"noted_heads", nullptr},      {"broken", nullptr}};
  if (result) {
    const AuditVerdict verdict{*result, std::move(heads)};
    body["proven"] = is_proven(verdict);
    body["head"] = {{"number", result->number}, {"hash", result->hash}};
    body["noted_heads"] = to_json(verdict)["noted_heads"];
  } else {
    body["broken"] = {{"number", result.error().number}, {"problem", result.error().problem}};
  }
  return body;
}

}  // namespace

AuditRoutes::AuditRoutes(const Context& context, Router& router) : context_(context) {
  router.add(boost::beast::http::verb::get, "/api/audit", admins,
             [this](const Call& call) { return records(call); });
  router.add(boost::beast::http::verb::get, "/api/audit/verify", admins,
             [this](const Call& call) { return verify(call); });
}

Answering AuditRoutes::records(const Call& call) const {
  const auto query = known_query(call.request, filter_fields);
  if (!query) {
    co_return fail(query.error());
  }
  Fields fields(*query, filter_fields);
  const auto count = fields.integer("records", 1, most_records).value_or(default_records);
  AuditFilter filter{.before = fields.integer("before", 1, std::numeric_limits<std::int64_t>::max()),
                     .kind = fields.text("kind"),
                     .actor = fields.text("actor"),
                     .text = fields.text("text")};
  if (const auto since = fields.text("since")) {
    filter.since = parse_iso_8601(*since);
    if (!filter.since) {
      fields.reject("since", *since, "a time such as 2024-05-01T12:34:56.789Z");
    }
  }
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  auto list_records = [count, filter = std::move(filter)](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<std::vector<AuditRecord>> {
      return Audit(transaction).list(static_cast<std::size_t>(count), filter);
    });
  };
  const auto found = co_await context_.store.run(std::move(list_records));
  co_return found.map([](const std::vector<AuditRecord>& records) {
    json list = json::array();
    for (const AuditRecord& record : records) {
      list.push_back(to_json(record));
    }
    return Success{.body = std::move(list)};
  });
}

Answering AuditRoutes::verify(const Call& call) const {
  const auto query = known_query(call.request, {"noted"});
  if (!query) {
    co_return fail(query.error());
  }
  Fields fields(*query, {"noted"});
  const auto noted = fields.text("noted");
  if (noted && !is_hash(*noted)) {
    fields.reject("noted", *noted, "a hash that was noted: 64 digits of 0 to 9 and a to f");
  }
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  const std::filesystem::path file = context_.noted_heads;
  auto read_heads = [file](Store& /*store*/) { return read_noted_heads(file); };
  const auto heads = co_await context_.store.run(std::move(read_heads));
  if (!heads) {
    co_return fail(heads.error());
  }
  // Shared: a part that nobody waits for any more may still be under way when this ends.
  const auto check = std::make_shared<AuditCheck>(noted, *heads);
  for (bool more = true; more;) {
    auto next_part = [check](Store& store) { return check_part(store, *check); };
    const auto part = co_await context_.store.run(std::move(next_part));
    if (!part) {
      co_return fail(part.error());
    }
    more = *part;
  }
  auto compare = [check, file, count = heads->size()](Store& store) -> Stored<ComparedHeads> {
    return compared_heads(*check, file, count, store.file());
  };
  auto compared = co_await context_.store.run(std::move(compare));
  if (!compared) {
    co_return fail(compared.error());
  }
  co_return Success{.body = check_json(*check, std::move(*compared), context_.clock())};
}

}  // namespace interlock::web
