/**
 * @file
 * Who is logged in.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "store/store.hpp"
#include "store/users.hpp"

namespace interlock {

constexpr std::chrono::minutes session_idle_limit{30};
constexpr std::chrono::hours session_lifetime{12};
constexpr int sessions_of_one_user = 16;

/** Somebody who is logged in. */
struct Session {
  std::uint32_t number = 0; /**< never given twice */
  User user;
  UtcTime created;
  UtcTime last_seen;

  /** When it ends at the latest. */
  [[nodiscard]] UtcTime expires() const { return created + session_lifetime; }

  bool operator==(const Session&) const = default;
};

/** A session that was just opened. The token is shown this once; the store keeps only its SHA-256. */
struct NewSession {
  Session session;
  std::string token;          /**< 256 random bits as base64url, 43 characters */
  std::vector<Session> ended; /**< sessions that had to make room */
};

/**
 * The sessions in one transaction. Whoever ends one by an operation of this class writes its audit record.
 *
 * A session lives from `create` until it is ended, 30 minutes after it was last seen, 12 hours after it was
 * created, or until its user is disabled. Times come from the caller.
 */
class Sessions {
 public:
  explicit Sessions(Transaction& transaction)
      : transaction_(transaction), database_(transaction.database()) {}

  /** Opens a session. Beyond 16 of a user, the oldest end. Refused: not_found, for nobody who may log in. */
  Stored<NewSession> create(const std::string& user, UtcTime now);

  /** The living session that the token opens. */
  [[nodiscard]] std::optional<Session> find(const std::string& token, UtcTime now) const;

  /** The living session of that number. */
  [[nodiscard]] std::optional<Session> find(std::uint32_t number, UtcTime now) const;

  /** The living sessions of that user, or of everybody; newest first. */
  [[nodiscard]] std::vector<Session> list(UtcTime now,
                                          const std::optional<std::string>& user = std::nullopt) const;

  /** As `find`, for whoever is about to change something. Refused: session_over, role (below `least`). */
  [[nodiscard]] Stored<Session> need(std::uint32_t number, Role least, UtcTime now) const;

  /** Notes that a session was used. One that is over stays over. */
  void touch(std::uint32_t number, UtcTime now);

  /** Ends one session; whether there was one of that number. */
  bool end(std::uint32_t number);

  /** Ends the user's sessions, but for one where one is given, and returns them. */
  std::vector<Session> end_all_of_user(const std::string& user,
                                       std::optional<std::uint32_t> except = std::nullopt);

  /** Forgets all that are over, and returns them. */
  std::vector<Session> end_expired(UtcTime now);

 private:
  void end_all(const std::vector<Session>& sessions);

  Transaction& transaction_;
  SQLite::Database& database_;
};

}  // namespace interlock
