#include "http/routes/account_routes.hpp"

#include <spdlog/spdlog.h>

#include "http/fields.hpp"
#include "http/problems.hpp"

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

Headers cookie(const std::string& token, std::chrono::seconds age) {
  return {{"Set-Cookie", std::string(session_cookie) + "=" + token + "; Path=/; HttpOnly; SameSite=Strict" +
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

/** Judges a name and a password and opens a session, all of it recorded. */
struct Login {
  std::string name;
  Password password;
  std::string peer;
  std::uint32_t former = 0; /**< session of the same browser, which ends */
  UtcTime now;

  /** Nothing when name or password is wrong. */
  Stored<std::optional<NewSession>> operator()(Store& store) const {
    const auto authenticated = authenticate(store, name, password);
    if (!authenticated) {
      return tl::unexpected(authenticated.error());
    }
    return store.transact([&](Transaction& transaction) -> Stored<std::optional<NewSession>> {
      if (!*authenticated || !Users(transaction).note_login(**authenticated, now)) {
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
  Session session;
  UtcTime now;

  Stored<void> operator()(Store& store) const {
    return store.transact([this](Transaction& transaction) -> Stored<void> {
      Sessions(transaction).end(session.number);
      Audit(transaction)
          .append({now, std::nullopt, session.user.name, session.number, AuditKind::logout, json::object()});
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
  Password current;
  Password next;
  UtcTime now;

  /** Nothing when the current password is wrong. */
  Stored<std::optional<ChangedPassword>> operator()(Store& store) const {
    const auto authenticated = authenticate(store, name, current);
    if (!authenticated) {
      return tl::unexpected(authenticated.error());
    }
    if (!*authenticated) {
      return std::nullopt;
    }
    const auto hash = PasswordHash::of_new(next, name);
    if (!hash) {
      StoreError error = hash.error();
      error.field = "new";
      return tl::unexpected(error);
    }
    return store.transact([&](Transaction& transaction) -> Stored<std::optional<ChangedPassword>> {
      Users users(transaction);
      if (!(users.password_of(name) == (*authenticated)->password)) {
        return std::nullopt;
      }
      return users.change(name, {.role = {}, .password = *hash, .enabled = {}}).map([&](const User& user) {
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
  const auto wait = guard_.wait(name, context_.clock());
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
  const UtcTime now = context_.clock();
  const std::uint32_t former = call.caller.session;
  guard_.begin(name, now);
  Login work{name, Password(std::move(credentials->second)), call.caller.peer, former, now};
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
  context_.sessions.end(former);
  spdlog::info("{}: {} logged in, session {}", call.caller.peer, name, made.session.number);
  co_return Success{Status::ok, session_json(made.session), cookie(made.token, session_lifetime)};
}

Answering AccountRoutes::logout(const Call& call) {
  const auto session = context_.sessions.known(call.caller.session);
  context_.sessions.end(call.caller.session);
  if (session) {
    // A store that fails keeps nobody logged in: the session has ended here, and will there.
    Logout work{*session, context_.clock()};
    (void)co_await context_.store.run(std::move(work));
  }
  spdlog::info("{} logged out, session {}", call.caller.user, call.caller.session);
  co_return Success{Status::ok, session_json(std::nullopt), cookie("", std::chrono::seconds(0))};
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
  const UtcTime now = context_.clock();
  guard_.begin(name, now);
  PasswordChange work{name, call.caller.session, Password(std::move(passwords->first)),
                      Password(std::move(passwords->second)), now};
  const auto changed = co_await context_.store.run(std::move(work));
  if (!changed) {
    guard_.end_unjudged(name);
    co_return fail(changed.error());
  }
  guard_.end(name, changed->has_value());
  if (!*changed) {
    co_return fail(wrong_credentials(Status::forbidden, "The current password is wrong."));
  }
  context_.sessions.forget((*changed)->ended);
  spdlog::info("{} changed the own password", name);
  co_return Success{Status::ok, to_json((*changed)->user)};
}

}  // namespace interlock::web
