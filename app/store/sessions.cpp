#include "store/sessions.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "store/digest.hpp"
#include "store/stored_time.hpp"
#include "store/user_row.hpp"

namespace interlock {
namespace {

constexpr const char* select_sessions =
    "SELECT number, sessions.created, last_seen, name, role, enabled, users.created, last_login "
    "FROM sessions JOIN users ON user = name ";

bool is_over(const Session& session, UtcTime now) {
  return !session.user.enabled || now >= session.expires() || now >= session.last_seen + session_idle_limit;
}

std::vector<Session> sessions_in(SQLite::Statement& rows) {
  std::vector<Session> sessions;
  while (rows.executeStep()) {
    sessions.push_back({static_cast<std::uint32_t>(rows.getColumn(0).getInt64()), user_in(rows, 3),
                        stored_time(rows.getColumn(1)), stored_time(rows.getColumn(2))});
  }
  return sessions;
}

std::optional<Session> living_session_in(SQLite::Statement& rows, UtcTime now) {
  std::vector<Session> sessions = sessions_in(rows);
  return sessions.empty() || is_over(sessions.front(), now) ? std::nullopt
                                                            : std::optional(std::move(sessions.front()));
}

}  // namespace

Stored<NewSession> Sessions::create(const std::string& user, UtcTime now) {
  const std::optional<User> found = Users(transaction_).find(user);
  if (!found || !found->enabled) {
    return tl::unexpected(StoreError{StoreError::Kind::not_found, "'" + user + "' may not log in", "name",
                                     "the name of an enabled user", ""});
  }
  NewSession session;
  session.token = random_token();
  SQLite::Statement insert(
      database_, "INSERT INTO sessions (user, token_hash, created, last_seen) VALUES (?, ?, ?3, ?3)");
  insert.bind(1, user);
  insert.bind(2, sha256_hex(session.token));
  insert.bind(3, iso_8601(now));
  insert.exec();
  SQLite::Statement rows(database_, std::string(select_sessions) + "WHERE user = ? ORDER BY number DESC");
  rows.bind(1, user);
  std::vector<Session> sessions = sessions_in(rows);
  session.session = sessions.front();
  if (sessions.size() > sessions_of_one_user) {
    session.ended.assign(sessions.begin() + sessions_of_one_user, sessions.end());
    end_all(session.ended);
  }
  return session;
}

std::optional<Session> Sessions::find(const std::string& token, UtcTime now) const {
  SQLite::Statement rows(database_, std::string(select_sessions) + "WHERE token_hash = ?");
  rows.bind(1, sha256_hex(token));
  return living_session_in(rows, now);
}

std::optional<Session> Sessions::find(std::uint32_t number, UtcTime now) const {
  SQLite::Statement rows(database_, std::string(select_sessions) + "WHERE number = ?");
  rows.bind(1, static_cast<std::int64_t>(number));
  return living_session_in(rows, now);
}

std::vector<Session> Sessions::list(UtcTime now, const std::optional<std::string>& user) const {
  SQLite::Statement rows(
      database_, std::string(select_sessions) + "WHERE user = coalesce(?, user) ORDER BY number DESC");
  if (user) {
    rows.bind(1, *user);
  }
  std::vector<Session> sessions = sessions_in(rows);
  std::erase_if(sessions, [&](const Session& session) { return is_over(session, now); });
  return sessions;
}

Stored<Session> Sessions::need(std::uint32_t number, Role least, UtcTime now) const {
  std::optional<Session> session = find(number, now);
  if (!session) {
    return tl::unexpected(StoreError{StoreError::Kind::session_over,
                                     "Nobody is logged in, or the session ended", "", "", "Log in."});
  }
  if (session->user.role < least) {
    const std::string is = session->user.name + " is " + std::string(role_name(session->user.role));
    return tl::unexpected(StoreError{StoreError::Kind::role, is, "", std::string(role_name(least)),
                                     "Log in as a user with that role, or ask an administrator for it."});
  }
  return std::move(*session);
}

void Sessions::touch(std::uint32_t number, UtcTime now) {
  if (!find(number, now)) {
    return;
  }
  SQLite::Statement update(database_, "UPDATE sessions SET last_seen = max(last_seen, ?) WHERE number = ?");
  update.bind(1, iso_8601(now));
  update.bind(2, static_cast<std::int64_t>(number));
  update.exec();
}

bool Sessions::end(std::uint32_t number) {
  SQLite::Statement remove(database_, "DELETE FROM sessions WHERE number = ?");
  remove.bind(1, static_cast<std::int64_t>(number));
  return remove.exec() != 0;
}

std::vector<Session> Sessions::end_all_of_user(const std::string& user, std::optional<std::uint32_t> except) {
  SQLite::Statement rows(database_, std::string(select_sessions) + "WHERE user = ? ORDER BY number");
  rows.bind(1, user);
  std::vector<Session> sessions = sessions_in(rows);
  std::erase_if(sessions, [&](const Session& session) { return except == session.number; });
  end_all(sessions);
  return sessions;
}

std::vector<Session> Sessions::end_expired(UtcTime now) {
  SQLite::Statement rows(database_, std::string(select_sessions) + "ORDER BY number");
  std::vector<Session> sessions = sessions_in(rows);
  std::erase_if(sessions, [&](const Session& session) { return !is_over(session, now); });
  end_all(sessions);
  return sessions;
}

void Sessions::end_all(const std::vector<Session>& sessions) {
  for (const Session& session : sessions) {
    end(session.number);
  }
}

}  // namespace interlock
