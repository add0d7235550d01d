#include <spdlog/spdlog.h>

#include <array>

#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/new_hash.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::array<std::string_view, 3> roles{"viewer", "engineer", "admin"};

/** Who administers. */
struct Administrator {
  std::string user;
  std::uint32_t session = 0;
  UtcTime now;

  /** Whether that is still so, as the transaction sees it. */
  [[nodiscard]] Stored<Session> need(Transaction& transaction) const {
    return Sessions(transaction).need(session, Role::admin, now);
  }

  [[nodiscard]] AuditEntry entry(json detail) const {
    return {now, std::nullopt, user, session, AuditKind::user, std::move(detail)};
  }
};

struct NewUser {
  std::string name;
  Role role = Role::viewer;
  PasswordHash password;
  Administrator by;

  Stored<User> operator()(Store& store) const {
    return store.transact([&](Transaction& transaction) {
      return by.need(transaction)
          .and_then([&](const Session&) { return Users(transaction).add(name, role, password, by.now); })
          .map([&](User user) {
            json detail{{"action", "add"}, {"name", name}, {"role", role_name(role)}};
            Audit(transaction).append(by.entry(std::move(detail)));
            return user;
          });
    });
  }
};

/** A user that was changed, and the sessions that ended by it. */
struct ChangedUser {
  User user;
  std::vector<Session> ended;
};

struct Change {
  std::string name;
  UserChange change;
  Administrator by;

  Stored<ChangedUser> operator()(Store& store) const {
    return store.transact([&](Transaction& transaction) -> Stored<ChangedUser> {
      if (const auto administers = by.need(transaction); !administers) {
        return tl::unexpected(administers.error());
      }
      Users users(transaction);
      const auto before = users.find(name);
      return users.change(name, change).map([&](const User& after) {
        ChangedUser changed{after, {}};
        if (change.password || !(before == after)) {
          changed.ended = Sessions(transaction).end_all_of_user(name);
          record(transaction, changed);
        }
        return changed;
      });
    });
  }

  void record(Transaction& transaction, const ChangedUser& changed) const {
    json detail{{"action", "change"},
                {"name", name},
                {"role", role_name(changed.user.role)},
                {"enabled", changed.user.enabled}};
    if (change.password) {
      detail["password"] = "changed";
    }
    Audit audit(transaction);
    audit.append(by.entry(std::move(detail)));
    for (const Session& each : changed.ended) {
      audit.append(session_ended(each, "user changed", by.now));
    }
  }
};

/** What the body of a request asks for. */
struct UserChange {
  std::string name;
  std::optional<Role> role;
  std::optional<bool> enabled;
  std::optional<Password> password;
};

UserChange read_change(Fields& fields, std::string name) {
  const auto role = fields.choice("role", roles);
  auto password = fields.text("password");
  UserChange change{std::move(name), role ? find_role(*role) : std::nullopt, std::nullopt, std::nullopt};
  if (password) {
    change.password.emplace(std::move(*password));
  }
  return change;
}

tl::expected<UserChange, Problem> new_user(const Request& request) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<UserChange, Problem> {
    Fields fields(body, {"name", "role", "password"});
    fields.require({{"name", "a text"}, {"role", "viewer, engineer or admin"}, {"password", "a text"}});
    UserChange change = read_change(fields, fields.text("name").value_or(""));
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return change;
  });
}

tl::expected<UserChange, Problem> change_of(const Request& request, const std::string& user) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<UserChange, Problem> {
    Fields fields(body, {"role", "password", "enabled"});
    UserChange change = read_change(fields, user);
    change.enabled = fields.boolean("enabled");
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return change;
  });
}

}  // namespace

UserRoutes::UserRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/users", admins, [this](const Call&) { return list(); });
  router.add(verb::post, "/api/users", admins, [this](const Call& call) { return add(call); });
  router.add(verb::put, "/api/users/{user}", admins, [this](const Call& call) { return change(call); });
}

Answering UserRoutes::list() const {
  const auto users = co_await context_.store.run([](Store& store) {
    return store.read(
        [](Transaction& transaction) -> Stored<std::vector<User>> { return Users(transaction).list(); });
  });
  co_return users.map([](const std::vector<User>& found) {
    json list = json::array();
    for (const User& each : found) {
      list.push_back(to_json(each));
    }
    return Success{Status::ok, std::move(list)};
  });
}

Answering UserRoutes::add(const Call& call) const {
  auto change = new_user(call.request);
  if (!change) {
    co_return fail(change.error());
  }
  auto hash = co_await new_hash(context_.work, change->name, std::move(*change->password), "password");
  if (!hash) {
    co_return fail(hash.error());
  }
  NewUser work{change->name,
               *change->role,
               std::move(*hash),
               {call.caller.user, call.caller.session, context_.clock()}};
  const auto added = co_await context_.store.run(std::move(work));
  if (added) {
    spdlog::info("{} added the user {}", call.caller.user, added->name);
  }
  co_return added.map([](const User& user) { return Success{Status::created, to_json(user)}; });
}

Answering UserRoutes::change(const Call& call) const {
  const std::string& user = call.parameters[0];
  auto look = [user](Store& store) {
    return store.read(
        [&](Transaction& transaction) -> Stored<bool> { return Users(transaction).find(user).has_value(); });
  };
  const auto exists = co_await context_.store.run(std::move(look));
  if (!exists || !*exists) {
    co_return fail(exists ? not_found("user " + user, "a name that /api/users lists") : exists.error());
  }
  auto change = change_of(call.request, user);
  if (!change) {
    co_return fail(change.error());
  }
  Change work{
      user, {change->role, std::nullopt, change->enabled}, {call.caller.user, call.caller.session, {}}};
  if (change->password) {
    auto hash = co_await new_hash(context_.work, user, std::move(*change->password), "password");
    if (!hash) {
      co_return fail(hash.error());
    }
    work.change.password = std::move(*hash);
  }
  work.by.now = context_.clock();
  const auto changed = co_await context_.store.run(std::move(work));
  if (!changed) {
    co_return fail(changed.error());
  }
  context_.sessions.forget(changed->ended);
  spdlog::info("{} changed the user {}", call.caller.user, user);
  co_return Success{Status::ok, to_json(changed->user)};
}

}  // namespace interlock::web
