/**
 * @file
 * Who may log in, and as what.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "store/password.hpp"
#include "store/store.hpp"

namespace interlock {

/** Each may do what those before may. */
enum class Role { viewer, engineer, admin };

/** "viewer", "engineer" or "admin". */
std::string_view role_name(Role role);

/** The role of that name. */
std::optional<Role> find_role(std::string_view name);

/** Somebody who may log in. */
struct User {
  std::string name;
  Role role = Role::viewer;
  bool enabled = true;
  UtcTime created;
  std::optional<UtcTime> last_login;

  bool operator==(const User&) const = default;
};

/** Schema `User` of spec/openapi.yaml. */
nlohmann::json to_json(const User& user);

/** What is left out stays. */
struct UserChange {
  std::optional<Role> role;
  std::optional<PasswordHash> password;
  std::optional<bool> enabled;
};

/** What a password is judged by. Of a name that is nobody's: no user, and a hash that no password fits. */
struct Credentials {
  std::optional<User> user;
  PasswordHash hash;
};

/** A user whose password was right, and the hash that it was right for. */
struct Authenticated {
  User user;
  PasswordHash password;
};

/** The users in one transaction. They are disabled and never removed, as the audit names them. */
class Users {
 public:
  explicit Users(Transaction& transaction) : database_(transaction.database()) {}

  /**
   * Adds a user who may log in at once.
   *
   * Refused: invalid (a name that is not ^[a-z][a-z0-9._-]{0,31}$), exists, last_admin (the very first user
   * is no administrator).
   */
  Stored<User> add(const std::string& name, Role role, const PasswordHash& password, UtcTime now);

  /** Changes a user. Refused: not_found, last_admin. Sessions stay as they are: see
   * `Sessions::end_all_of_user`. */
  Stored<User> change(const std::string& name, const UserChange& change);

  /** Writes down a login. Refused, outdated: the user was disabled, or has another password by now. */
  Stored<User> note_login(const Authenticated& login, UtcTime now);

  /** The user of that name, where there is one. */
  [[nodiscard]] std::optional<User> find(const std::string& name) const;

  /** Everybody, by name. */
  [[nodiscard]] std::vector<User> list() const;

  /** The hash of the user's password; that of a password which nobody knows for a name that is nobody's. */
  [[nodiscard]] PasswordHash password_of(const std::string& name) const;

 private:
  [[nodiscard]] bool is_last_admin(const User& user) const;

  SQLite::Database& database_;
};

/** What the password of that name is judged by. */
Stored<Credentials> credentials_of(Store& store, const std::string& name);

/** Judges a password; nothing when it is wrong or the user is disabled. Takes about a tenth of a second and
 * 64 MiB, also for a name that is nobody's. Refused: no_memory. */
Stored<std::optional<Authenticated>> judge(const Credentials& credentials, const Password& password);

/**
 * Checks a name and a password; nothing when either is wrong or the user is disabled.
 *
 * Takes as long for a name that is nobody's as for a wrong password (about a tenth of a second), and holds no
 * transaction meanwhile.
 */
Stored<std::optional<Authenticated>> authenticate(Store& store, const std::string& name,
                                                  const Password& password);

}  // namespace interlock
