#include "http/routes/audit_routes.hpp"

#include <limits>

#include "http/fields.hpp"
#include "http/problems.hpp"
#include "http/query.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using nlohmann::json;

constexpr std::int64_t default_records = 100;
constexpr std::int64_t most_records = 1000;

}  // namespace

AuditRoutes::AuditRoutes(const Context& context, Router& router) : context_(context) {
  router.add(boost::beast::http::verb::get, "/api/audit", admins,
             [this](const Call& call) { return records(call); });
}

Answering AuditRoutes::records(const Call& call) const {
  const auto query = known_query(call.request, {"records", "before"});
  if (!query) {
    co_return fail(query.error());
  }
  Fields fields(*query, {"records", "before"});
  const auto count = fields.integer("records", 1, most_records).value_or(default_records);
  const auto before = fields.integer("before", 1, std::numeric_limits<std::int64_t>::max());
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  auto list_records = [count, before](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<std::vector<AuditRecord>> {
      return Audit(transaction).list(static_cast<std::size_t>(count), before);
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

}  // namespace interlock::web
