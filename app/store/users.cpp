#include "store/users.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "store/digest.hpp"
#include "store/stored_time.hpp"
#include "store/user_row.hpp"

namespace interlock {
namespace {

constexpr std::size_t longest_name = 32;
/** What the audit calls actors that are no users. */
constexpr std::array<std::string_view, 3> reserved_names{"kernel", "app", "nobody"};
/** Hash of a password that nobody knows, of the same cost as any: names that are nobody's take as long to
 * refuse. */
constexpr const char* hash_of_nobody =
    "$argon2id$v=19$m=65536,t=2,p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

bool is_name(std::string_view name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= longest_name && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
         });
}

Stored<void> check_name(const std::string& name) {
  if (!is_name(name)) {
    return tl::unexpected(
        StoreError{StoreError::Kind::invalid, "'" + name + "' is no name of a user", "name",
                   "a lower-case letter, then up to 31 lower-case letters, digits, '.', '_' or '-'", ""});
  }
  if (std::find(reserved_names.begin(), reserved_names.end(), name) != reserved_names.end()) {
    return tl::unexpected(StoreError{StoreError::Kind::invalid,
                                     "the name " + name + " means something else in the audit", "name",
                                     "a name that is not kernel, app or nobody", ""});
  }
  return {};
}

StoreError no_user(const std::string& name) {
  return {StoreError::Kind::not_found, "there is no user '" + name + "'", "name", "the name of a user",
          "see the list of users"};
}

StoreError no_memory_to_judge() {
  return {StoreError::Kind::no_memory, "there is not enough memory to check a password", "", "64 MiB free",
          "try again in a moment, or end other programs"};
}

constexpr const char* select_users = "SELECT name, role, enabled, created, last_login FROM users ";

}  // namespace

std::string_view role_name(Role role) {
  switch (role) {
    case Role::viewer:
      return "viewer";
    case Role::engineer:
      return "engineer";
    case Role::admin:
      return "admin";
  }
  return "unknown";
}

std::optional<Role> find_role(std::string_view name) {
  for (const Role role : {Role::viewer, Role::engineer, Role::admin}) {
    if (role_name(role) == name) {
      return role;
    }
  }
  return std::nullopt;
}

nlohmann::json to_json(const User& user) {
  return {{"name", user.name},
          {"role", role_name(user.role)},
          {"enabled", user.enabled},
          {"created", iso_8601(user.created)},
          {"last_login", user.last_login ? nlohmann::json(iso_8601(*user.last_login)) : nlohmann::json()}};
}

User user_in(SQLite::Statement& row, int first) {
  const std::string role_text = row.getColumn(first + 1).getString();
  const std::optional<Role> role = find_role(role_text);
  if (!role) {
    throw SQLite::Exception("'" + role_text + "' is no role", SQLITE_CORRUPT);
  }
  const SQLite::Column last_login = row.getColumn(first + 4);
  return {row.getColumn(first).getString(), *role, row.getColumn(first + 2).getInt() != 0,
          stored_time(row.getColumn(first + 3)),
          last_login.isNull() ? std::nullopt : std::optional(stored_time(last_login))};
}

std::map<std::string, std::string> user_digests(SQLite::Database& database) {
  SQLite::Statement rows(database, "SELECT name, role, enabled, password FROM users");
  std::map<std::string, std::string> digests;
  while (rows.executeStep()) {
    std::string row;
    for (int column = 0; column < rows.getColumnCount(); ++column) {
      row += rows.getColumn(column).getString() + '\n';
    }
    digests[rows.getColumn(0).getString()] = sha256_hex(row);
  }
  return digests;
}

Stored<User> Users::add(const std::string& name, Role role, const PasswordHash& password, UtcTime now) {
  if (const Stored<void> checked = check_name(name); !checked) {
    return tl::unexpected(checked.error());
  }
  if (find(name)) {
    return tl::unexpected(StoreError{StoreError::Kind::exists, "there is a user '" + name + "' already",
                                     "name", "a new name", "choose another, or change that user"});
  }
  if (role != Role::admin && list().empty()) {
    return tl::unexpected(
        StoreError{StoreError::Kind::last_admin, "the first user is to be " + std::string(role_name(role)),
                   "role", "admin, as somebody must be able to administer", "add an administrator first"});
  }
  SQLite::Statement insert(
      database_, "INSERT INTO users (name, role, enabled, password, created) VALUES (?, ?, 1, ?, ?)");
  insert.bind(1, name);
  insert.bind(2, std::string(role_name(role)));
  insert.bind(3, password.text());
  insert.bind(4, iso_8601(now));
  insert.exec();
  return find(name).value();
}

Stored<User> Users::change(const std::string& name, const UserChange& change) {
  const std::optional<User> before = find(name);
  if (!before) {
    return tl::unexpected(no_user(name));
  }
  const Role role = change.role.value_or(before->role);
  const bool enabled = change.enabled.value_or(before->enabled);
  if ((role != Role::admin || !enabled) && is_last_admin(*before)) {
    return tl::unexpected(StoreError{StoreError::Kind::last_admin,
                                     "'" + name + "' is the last who may administer",
                                     enabled ? "role" : "enabled", "an enabled administrator besides",
                                     "make somebody else administrator first"});
  }
  SQLite::Statement update(
      database_, "UPDATE users SET role = ?, enabled = ?, password = coalesce(?, password) WHERE name = ?");
  update.bind(1, std::string(role_name(role)));
  update.bind(2, enabled ? 1 : 0);
  if (change.password) {
    update.bind(3, change.password->text());
  }
  update.bind(4, name);
  update.exec();
  return find(name).value();
}

Stored<User> Users::note_login(const Authenticated& login, UtcTime now) {
  SQLite::Statement update(database_,
                           "UPDATE users SET last_login = ? WHERE name = ? AND password = ? AND enabled = 1");
  update.bind(1, iso_8601(now));
  update.bind(2, login.user.name);
  update.bind(3, login.password.text());
  if (update.exec() == 0) {
    return tl::unexpected(StoreError{StoreError::Kind::outdated,
                                     "'" + login.user.name + "' was disabled or has a new password by now",
                                     "", "", "log in again"});
  }
  return find(login.user.name).value();
}

std::optional<User> Users::find(const std::string& name) const {
  SQLite::Statement select(database_, std::string(select_users) + "WHERE name = ?");
  select.bind(1, name);
  return select.executeStep() ? std::optional(user_in(select, 0)) : std::nullopt;
}

std::vector<User> Users::list() const {
  SQLite::Statement select(database_, std::string(select_users) + "ORDER BY name");
  std::vector<User> users;
  while (select.executeStep()) {
    users.push_back(user_in(select, 0));
  }
  return users;
}

PasswordHash Users::password_of(const std::string& name) const {
  SQLite::Statement select(database_, "SELECT password FROM users WHERE name = ?");
  select.bind(1, name);
  return PasswordHash(select.executeStep() ? select.getColumn(0).getString() : hash_of_nobody);
}

bool Users::is_last_admin(const User& user) const {
  return user.role == Role::admin && user.enabled &&
         database_.execAndGet("SELECT count(*) FROM users WHERE role = 'admin' AND enabled = 1").getInt() ==
             1;
}

Stored<Credentials> credentials_of(Store& store, const std::string& name) {
  return store.read([&](Transaction& transaction) -> Stored<Credentials> {
    const Users users(transaction);
    return Credentials{users.find(name), users.password_of(name)};
  });
}

Stored<std::optional<Authenticated>> judge(const Credentials& credentials, const Password& password) {
  const PasswordHash::Match match = credentials.hash.compare(password);
  if (match == PasswordHash::Match::no_memory) {
    return tl::unexpected(no_memory_to_judge());
  }
  if (match == PasswordHash::Match::wrong || !credentials.user || !credentials.user->enabled) {
    return std::nullopt;
  }
  return Authenticated{*credentials.user, credentials.hash};
}

Stored<std::optional<Authenticated>> authenticate(Store& store, const std::string& name,
                                                  const Password& password) {
  return credentials_of(store, name).and_then([&](const Credentials& found) {
    return judge(found, password);
  });
}

}  // namespace interlock
