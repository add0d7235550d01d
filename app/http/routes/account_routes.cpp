#include "http/routes/account_routes.hpp"

#include <spdlog/spdlog.h>

#include "http/fields.hpp"
#include "http/new_hash.hpp"
#include "http/problems.hpp"
#include "http/same_origin.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

json session_json(const std::optional<Session>& session) {
  if (!session) {
    return {{"user", nullptr}, {"session", nullptr}, {"expires", nullptr}};
  }
  return {{"user", to_json(session->user)},
          {"session", session->number},
          {"expires", iso_8601(session->expires())}};
}

Headers cookie(const Request& request, const std::string& token, std::chrono::seconds age) {
  return {{"Set-Cookie", session_cookie(request) + "=" + token + "; Path=/; HttpOnly; SameSite=Strict" +
                             "; Max-Age=" + std::to_string(age.count())}};
}

Problem wrong_credentials(Status status, const std::string& detail) {
  return {.status = status, .code = "CREDENTIALS", .detail = detail};
}

/** The texts of those two required fields. */
tl::expected<std::pair<std::string, std::string>, Problem> two_texts(const Request& request,
                                                                     const char* first, const char* second) {
  return parse_body(request).and_then(
      [&](const json& body) -> tl::expected<std::pair<std::string, std::string>, Problem> {
        Fields fields(body, {first, second});
        fields.require({{first, "a text"}, {second, "a text"}});
        const auto one = fields.text(first);
        const auto other = fields.text(second);
        if (fields.problem()) {
          return fail(*fields.problem());
        }
        return std::pair(*one, *other);
      });
}

Problem logged_out_here_only(const Request& request, const Problem& failure) {
  return {.status = failure.status,
          .code = failure.code,
          .detail = "You are logged out, but the store does not know it yet: " + failure.detail,
          .next_step =
              "Nothing; it is told as soon as it works. Only if the app ends before that, the session "
              "lives until it expires.",
          .headers = cookie(request, "", std::chrono::seconds(0))};
}

/** Opens a session for whoever gave the right password, or records that somebody did not. */
struct Login {
  std::string name;
  std::optional<Authenticated> authenticated;
  std::string peer;
  std::uint32_t former = 0; /**< session of the same browser, which ends */
  UtcTime now;

  /** Nothing when name or password is wrong, or has become so meanwhile. */
  Stored<std::optional<NewSession>> operator()(Store& store) const {
    return store.transact([&](Transaction& transaction) -> Stored<std::optional<NewSession>> {
      if (!authenticated || !Users(transaction).note_login(*authenticated, now)) {
        refuse(transaction);
        return std::nullopt;
      }
      return open(transaction).map([](NewSession made) { return std::optional(std::move(made)); });
    });
  }

  /** Who types the password in the place of the name shall not find it in the audit. */
  void refuse(Transaction& transaction) const {
    const bool known = Users(transaction).find(name).has_value();
    Audit(transaction)
        .append({now,
                 std::nullopt,
                 audit_actor::nobody,
                 std::nullopt,
                 AuditKind::login_refused,
                 {{"name", known ? json(name) : json()}, {"peer", peer}}});
  }

  Stored<NewSession> open(Transaction& transaction) const {
    Sessions sessions(transaction);
    Audit audit(transaction);
    if (const auto left = sessions.find(former, now)) {
      sessions.end(former);
      audit.append(session_ended(*left, "new login", now));
    }
    auto made = sessions.create(name, now);
    if (made) {
      audit.append({now, std::nullopt, name, made->session.number, AuditKind::login, {{"peer", peer}}});
      for (const Session& oldest : made->ended) {
        audit.append(session_ended(oldest, "too many sessions", now));
      }
    }
    return made;
  }
};

struct Logout {
  std::uint32_t session = 0;
  AuditEntry record;

  Stored<void> operator()(Store& store) const {
    return store.transact([this](Transaction& transaction) -> Stored<void> {
      if (Sessions(transaction).end(session)) {
        Audit(transaction).append(record);
      }
      return {};
    });
  }
};

/** A password that was changed, and the sessions that ended by it. */
struct ChangedPassword {
  User user;
  std::vector<Session> ended;
};

struct PasswordChange {
  std::string name;
  std::uint32_t session = 0; /**< goes on */
  PasswordHash current;
  PasswordHash next;
  UtcTime now;

  /** Nothing when the current password is another one by now. */
  Stored<std::optional<ChangedPassword>> operator()(Store& store) const {
    return store.transact([&](Transaction& transaction) -> Stored<std::optional<ChangedPassword>> {
      if (const auto lives = Sessions(transaction).need(session, Role::viewer, now); !lives) {
        return tl::unexpected(lives.error());
      }
      Users users(transaction);
      if (!(users.password_of(name) == current)) {
        return std::nullopt;
      }
      return users.change(name, {.role = {}, .password = next, .enabled = {}}).map([&](const User& user) {
        ChangedPassword changed{user, Sessions(transaction).end_all_of_user(name, session)};
        Audit audit(transaction);
        json detail{{"action", "change"}, {"name", name}, {"password", "changed"}};
        audit.append({now, std::nullopt, name, session, AuditKind::user, std::move(detail)});
        for (const Session& each : changed.ended) {
          audit.append(session_ended(each, "password changed", now));
        }
        return std::optional(std::move(changed));
      });
    });
  }
};

}  // namespace

AccountRoutes::AccountRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/session", anybody,
             [this](const Call& call) -> Answering { co_return session(call); });
  router.add(verb::post, "/api/login", anybody, [this](const Call& call) { return login(call); });
  router.add(verb::post, "/api/logout", viewers, [this](const Call& call) { return logout(call); });
  router.add(verb::put, "/api/password", viewers, [this](const Call& call) { return change_password(call); });
}

Reply AccountRoutes::session(const Call& call) const {
  return Success{Status::ok, session_json(context_.sessions.known(call.caller.session))};
}

tl::expected<void, Problem> AccountRoutes::need_no_wait(const std::string& name) const {
  const auto wait = guard_.wait(name, context_.steady_clock());
  if (wait.count() == 0) {
    return {};
  }
  const std::string seconds = std::to_string(wait.count());
  return fail({.status = Status::too_many_requests,
               .code = "BACK_OFF",
               .detail = "Too many wrong passwords.",
               .next_step = "Try again in " + seconds + " s.",
               .headers = {{"Retry-After", seconds}}});
}

Answering AccountRoutes::login(const Call& call) {
  auto credentials = two_texts(call.request, "name", "password");
  if (!credentials) {
    co_return fail(credentials.error());
  }
  const std::string name = credentials->first;
  if (const auto free = need_no_wait(name); !free) {
    co_return fail(free.error());
  }
  guard_.begin(name, context_.steady_clock());
  Password password(std::move(credentials->second));
  auto authenticated = co_await authenticate(name, std::move(password));
  if (!authenticated) {
    guard_.end_unjudged(name);
    co_return fail(authenticated.error());
  }
  const std::uint32_t former = call.caller.session;
  Login work{name, std::move(*authenticated), call.caller.peer, former, context_.clock()};
  auto opened = co_await context_.store.run(std::move(work));
  if (!opened) {
    guard_.end_unjudged(name);
    co_return fail(opened.error());
  }
  guard_.end(name, opened->has_value());
  if (!*opened) {
    spdlog::warn("{}: a login was refused", call.caller.peer);
    co_return fail(
        wrong_credentials(Status::unauthorized, "Name or password is wrong, or the user is disabled."));
  }
  const NewSession& made = **opened;
  context_.sessions.add(made);
  context_.sessions.forget(made.ended);
  context_.sessions.forget(former);
  spdlog::info("{}: {} logged in, session {}", call.caller.peer, name, made.session.number);
  co_return Success{Status::ok, session_json(made.session),
                    cookie(call.request, made.token, session_lifetime)};
}

Answering AccountRoutes::logout(const Call& call) {
  // A store that fails keeps nobody logged in: the session ends here at once, and there when it can.
  Logout work{call.caller.session, context_.entry(call.caller, AuditKind::logout, json::object())};
  context_.sessions.end(call.caller.session, work.record);
  spdlog::info("{} logged out, session {}", call.caller.user, call.caller.session);
  const auto stored = co_await context_.store.run(std::move(work));
  if (!stored) {
    co_return fail(logged_out_here_only(call.request, stored.error()));
  }
  co_return Success{Status::ok, session_json(std::nullopt),
                    cookie(call.request, "", std::chrono::seconds(0))};
}

boost::asio::awaitable<tl::expected<std::optional<Authenticated>, Problem>> AccountRoutes::authenticate(
    std::string name, Password password) {
  auto look = [name](Store& store) { return credentials_of(store, name); };
  auto found = co_await context_.store.run(std::move(look));
  if (!found) {
    co_return fail(found.error());
  }
  auto work = [found = std::move(*found), password = std::move(password)] { return judge(found, password); };
  co_return co_await context_.work.run(std::move(work));
}

Answering AccountRoutes::change_password(const Call& call) {
  auto passwords = two_texts(call.request, "current", "new");
  if (!passwords) {
    co_return fail(passwords.error());
  }
  const std::string name = call.caller.user;
  if (const auto free = need_no_wait(name); !free) {
    co_return fail(free.error());
  }
  guard_.begin(name, context_.steady_clock());
  Password current(std::move(passwords->first));
  auto authenticated = co_await authenticate(name, std::move(current));
  if (!authenticated) {
    guard_.end_unjudged(name);
    co_return fail(authenticated.error());
  }
  guard_.end(name, authenticated->has_value());
  if (!*authenticated) {
    co_return fail(wrong_credentials(Status::forbidden, "The current password is wrong."));
  }
  Password wished(std::move(passwords->second));
  const auto next = co_await new_hash(context_.work, name, std::move(wished), "new");
  if (!next) {
    co_return fail(next.error());
  }
  PasswordChange work{name, call.caller.session, (*authenticated)->password, *next, context_.clock()};
  const auto changed = co_await context_.store.run(std::move(work));
  if (!changed) {
    co_return fail(changed.error());
  }
  if (!*changed) {
    co_return fail(wrong_credentials(Status::forbidden, "The current password is wrong."));
  }
  context_.sessions.forget((*changed)->ended);
  spdlog::info("{} changed the own password", name);
  co_return Success{Status::ok, to_json((*changed)->user)};
}

}  // namespace interlock::web
