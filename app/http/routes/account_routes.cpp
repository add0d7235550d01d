#include <spdlog/spdlog.h>

#include <boost/asio/steady_timer.hpp>

#include "http/routes.hpp"
#include "http/same_origin.hpp"
#include "service/fields.hpp"
#include "service/new_hash.hpp"
#include "service/reply.hpp"
#include "store/digest.hpp"
#include "system/as_result.hpp"

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

Headers cookie(const std::string& name, const std::string& token, std::chrono::seconds age) {
  return {{"Set-Cookie", name + "=" + token + "; Path=/; HttpOnly; SameSite=Strict" +
                             "; Max-Age=" + std::to_string(age.count())}};
}

/** By which the login guard knows a browser again, until the app ends. */
std::string browser_cookie(const Request& request) { return session_cookie(request) + "_browser"; }
constexpr std::chrono::days browser_lifetime{90};

/** What a peer can be told by: its address without the port. Every address of the loopback interface is the
 * same, since any process of this machine may choose among them. */
std::string address_of(const std::string& peer) {
  const std::string address = peer.substr(0, peer.rfind(':'));
  return address.starts_with("127.") || address == "[::1]" ? "loopback" : address;
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
          .headers = cookie(session_cookie(request), "", std::chrono::seconds(0))};
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

/** Whose sessions the caller may see and end: only the own ones, unless the caller administers. */
std::optional<std::string> sessions_within_reach(const Caller& caller) {
  return caller.role == Role::admin ? std::nullopt : std::optional(caller.user);
}

/** Ends a session of the user, or of anybody. */
struct SessionEnd {
  std::uint32_t number = 0;
  std::optional<std::string> user;
  Caller by;
  UtcTime now;

  /** Nothing when there is no such session, or it is somebody else's. */
  Stored<std::optional<Session>> operator()(Store& store) const {
    return store.transact([&](Transaction& transaction) -> Stored<std::optional<Session>> {
      Sessions sessions(transaction);
      const Role least = user ? Role::viewer : Role::admin;
      if (const auto lives = sessions.need(by.session, least, now); !lives) {
        return tl::unexpected(lives.error());
      }
      auto found = sessions.find(number, now);
      if (!found || (user && found->user.name != *user)) {
        return std::nullopt;
      }
      sessions.end(number);
      json detail{{"session", number}, {"user", found->user.name}, {"reason", "ended by a user"}};
      Audit(transaction)
          .append({now, std::nullopt, by.user, by.session, AuditKind::session_ended, std::move(detail)});
      return found;
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
  router.add(verb::get, "/api/sessions", viewers, [this](const Call& call) { return sessions(call); });
  router.add(verb::delete_, "/api/sessions/{session}", viewers,
             [this](const Call& call) { return end_session(call); });
  router.add(verb::post, "/api/login", anybody, [this](const Call& call) { return login(call); });
  router.add(verb::post, "/api/logout", viewers, [this](const Call& call) { return logout(call); });
  router.add(verb::put, "/api/password", viewers, [this](const Call& call) { return change_password(call); });
}

Reply AccountRoutes::session(const Call& call) const {
  return Success{Status::ok, session_json(context_.sessions.known(call.caller.session))};
}

/** What is known of a session besides its token. */
json AccountRoutes::listed(const Session& session, const Caller& caller) const {
  const auto here = context_.sessions.known(session.number);
  const auto peer = context_.sessions.peer_of(session.number);
  return {{"session", session.number},
          {"user", session.user.name},
          {"since", iso_8601(session.created)},
          {"last_use", iso_8601(std::max(session.last_seen, here ? here->last_seen : session.last_seen))},
          {"expires", iso_8601(session.expires())},
          {"address", peer ? json(*peer) : json()},
          {"mine", session.number == caller.session}};
}

Answering AccountRoutes::sessions(const Call& call) {
  auto look = [now = context_.clock(), user = sessions_within_reach(call.caller)](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<std::vector<Session>> {
      return Sessions(transaction).list(now, user);
    });
  };
  const auto found = co_await context_.store.run(std::move(look));
  if (!found) {
    co_return fail(found.error());
  }
  json list = json::array();
  for (const Session& each : *found) {
    list.push_back(listed(each, call.caller));
  }
  co_return Success{.body = std::move(list)};
}

Answering AccountRoutes::end_session(const Call& call) {
  const auto number = number_in(call.parameters[0]);
  SessionEnd work{number.value_or(0), sessions_within_reach(call.caller), call.caller, context_.clock()};
  const auto ended = co_await context_.store.run(std::move(work));
  if (!ended) {
    co_return fail(ended.error());
  }
  if (!*ended) {
    co_return fail(not_found("session " + call.parameters[0], "a number that /api/sessions lists"));
  }
  json last = listed(**ended, call.caller);
  context_.sessions.forget((*ended)->number);
  spdlog::info("{} ended session {} of {}", call.caller.user, (*ended)->number, (*ended)->user.name);
  co_return Success{.body = std::move(last)};
}

tl::expected<LoginGuard::Attempt, Problem> AccountRoutes::begin_attempt(const Call& call,
                                                                        const std::string& name) {
  const std::vector<std::string> tokens = cookies_of(call.request, browser_cookie(call.request));
  auto attempt = guard_.begin({address_of(call.caller.peer), name, tokens.empty() ? "" : tokens.front()},
                              context_.steady_clock());
  if (attempt) {
    return std::move(*attempt);
  }
  return fail({.status = Status::too_many_requests,
               .code = "BACK_OFF",
               .detail = "Too many logins are under way.",
               .next_step = "Try again in 1 s.",
               .headers = {{"Retry-After", "1"}}});
}

boost::asio::awaitable<void> AccountRoutes::pause(std::chrono::seconds time) const {
  if (time.count() != 0) {
    boost::asio::steady_timer timer(context_.executor, time);
    co_await timer.async_wait(as_result);
  }
}

Answering AccountRoutes::login(const Call& call) {
  auto credentials = two_texts(call.request, "name", "password");
  if (!credentials) {
    co_return fail(credentials.error());
  }
  const std::string name = credentials->first;
  Password password(std::move(credentials->second));
  auto attempt = begin_attempt(call, name);
  if (!attempt) {
    co_return fail(attempt.error());
  }
  co_await pause(attempt->delay());
  auto authenticated = co_await authenticate(name, std::move(password));
  if (!authenticated) {
    co_return fail(authenticated.error());
  }
  const std::uint32_t former = call.caller.session;
  Login work{name, std::move(*authenticated), call.caller.peer, former, context_.clock()};
  auto opened = co_await context_.store.run(std::move(work));
  if (!opened) {
    co_return fail(opened.error());
  }
  attempt->judged(opened->has_value());
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
  const std::string browser = random_token();
  guard_.know(browser, name, context_.steady_clock());
  Headers cookies = cookie(session_cookie(call.request), made.token, session_lifetime);
  cookies.push_back(cookie(browser_cookie(call.request), browser, browser_lifetime).front());
  co_return Success{Status::ok, session_json(made.session), std::move(cookies)};
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
                    cookie(session_cookie(call.request), "", std::chrono::seconds(0))};
}

boost::asio::awaitable<tl::expected<std::optional<Authenticated>, Problem>> AccountRoutes::authenticate(
    std::string name, Password password) {
  auto look = [name](Store& store) { return credentials_of(store, name); };
  auto found = co_await context_.store.run(std::move(look));
  if (!found) {
    co_return fail(found.error());
  }
  auto work = [found = std::move(*found), password = std::move(password)] { return judge(found, password); };
  auto judged = co_await context_.work.run(std::move(work));
  if (!judged) {
    co_return fail(judged.error());
  }
  if (!*judged) {
    co_return fail(problem_of(judged->error()));
  }
  co_return std::move(**judged);
}

Answering AccountRoutes::change_password(const Call& call) {
  auto passwords = two_texts(call.request, "current", "new");
  if (!passwords) {
    co_return fail(passwords.error());
  }
  const std::string name = call.caller.user;
  Password current(std::move(passwords->first));
  auto attempt = begin_attempt(call, name);
  if (!attempt) {
    co_return fail(attempt.error());
  }
  co_await pause(attempt->delay());
  auto authenticated = co_await authenticate(name, std::move(current));
  if (!authenticated) {
    co_return fail(authenticated.error());
  }
  attempt->judged(authenticated->has_value());
  if (!*authenticated) {
    co_return fail(wrong_credentials(Status::forbidden, "The current password is wrong."));
  }
  Password requested(std::move(passwords->second));
  const auto next = co_await new_hash(context_.work, name, std::move(requested), "new");
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
