#include "http/routes/user_routes.hpp"

#include <spdlog/spdlog.h>

#include <array>

#include "http/fields.hpp"
#include "http/problems.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::array<std::string_view, 3> roles{"viewer", "engineer", "admin"};

/** Who administers, for the audit. */
struct Administrator {
  std::string user;
  std::uint32_t session = 0;
  UtcTime now;

  [[nodiscard]] AuditEntry entry(json detail) const {
    return {now, std::nullopt, user, session, AuditKind::user, std::move(detail)};
  }
};

struct NewUser {
  std::string name;
  Role role = Role::viewer;
  Password password;
  Administrator by;

  Stored<User> operator()(Store& store) const {
    const auto hash = PasswordHash::of_new(password, name);
    if (!hash) {
      return tl::unexpected(hash.error());
    }
    return store.transact([&](Transaction& transaction) {
      return Users(transaction).add(name, role, *hash, by.now).map([&](User user) {
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
  std::optional<Role> role;
  std::optional<bool> enabled;
  std::optional<Password> password;
  Administrator by;

  Stored<ChangedUser> operator()(Store& store) const {
    UserChange change{role, std::nullopt, enabled};
    if (password) {
      const auto hash = PasswordHash::of_new(*password, name);
      if (!hash) {
        return tl::unexpected(hash.error());
      }
      change.password = *hash;
    }
    return store.transact([&](Transaction& transaction) -> Stored<ChangedUser> {
      Users users(transaction);
      const auto before = users.find(name);
      return users.change(name, change).map([&](const User& after) {
        ChangedUser changed{after, {}};
        if (password || !(before == after)) {
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
    if (password) {
      detail["password"] = "changed";
    }
    Audit audit(transaction);
    audit.append(by.entry(std::move(detail)));
    for (const Session& each : changed.ended) {
      audit.append(session_ended(each, "user changed", by.now));
    }
  }
};

tl::expected<NewUser, Problem> new_user(const Request& request, Administrator by) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<NewUser, Problem> {
    Fields fields(body, {"name", "role", "password"});
    fields.require({{"name", "a text"}, {"role", "viewer, engineer or admin"}, {"password", "a text"}});
    const auto name = fields.text("name");
    const auto role = fields.choice("role", roles);
    auto password = fields.text("password");
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return NewUser{*name, *find_role(*role), Password(std::move(*password)), std::move(by)};
  });
}

tl::expected<Change, Problem> change_of(const Request& request, const std::string& user, Administrator by) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<Change, Problem> {
    Fields fields(body, {"role", "password", "enabled"});
    const auto role = fields.choice("role", roles);
    auto password = fields.text("password");
    const auto enabled = fields.boolean("enabled");
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    Change change{user, role ? find_role(*role) : std::nullopt, enabled, std::nullopt, std::move(by)};
    if (password) {
      change.password.emplace(std::move(*password));
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
  auto wished = new_user(call.request, {call.caller.user, call.caller.session, context_.clock()});
  if (!wished) {
    co_return fail(wished.error());
  }
  const auto added = co_await context_.store.run(std::move(*wished));
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
  auto wished = change_of(call.request, user, {call.caller.user, call.caller.session, context_.clock()});
  if (!wished) {
    co_return fail(wished.error());
  }
  const auto changed = co_await context_.store.run(std::move(*wished));
  if (!changed) {
    co_return fail(changed.error());
  }
  context_.sessions.forget(changed->ended);
  spdlog::info("{} changed the user {}", call.caller.user, user);
  co_return Success{Status::ok, to_json(changed->user)};
}

}  // namespace interlock::web
