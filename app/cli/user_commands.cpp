#include <algorithm>
#include <iomanip>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/password_prompt.hpp"
#include "store/audit.hpp"
#include "store/sessions.hpp"
#include "store/users.hpp"
#include "system/printable.hpp"

namespace interlock::cli {
namespace {

/** A new password, hashed. No transaction waits for it. */
Result<PasswordHash> new_password(const UserOptions& options) {
  const Result<Password> password =
      options.password_from_stdin ? read_password() : ask_for_new_password(options.name);
  if (!password) {
    return tl::unexpected(password.error());
  }
  return PasswordHash::of_new(*password, options.name).map_error(failure_of);
}

void record(Transaction& transaction, AuditKind kind, nlohmann::json detail, UtcTime now) {
  Audit(transaction)
      .append({now, std::nullopt, audit_actor::command_line, std::nullopt, kind, std::move(detail)});
}

}  // namespace

Result<void> add_user(const UserOptions& options, const Installation& installation, std::ostream& output) {
  const Result<std::filesystem::path> file = store_file(options.place, installation);
  if (!file) {
    return tl::unexpected(file.error());
  }
  const std::optional<Role> role = find_role(options.role);
  if (!role) {
    return failed(ExitCode::usage, "'" + options.role + "' is no role; expected viewer, engineer or admin");
  }
  const Result<PasswordHash> password = new_password(options);
  if (!password) {
    return tl::unexpected(password.error());
  }
  Stored<Store> store = Store::open(*file);
  if (!store) {
    return tl::unexpected(failure_of(store.error()));
  }
  const UtcTime now = std::chrono::system_clock::now();
  const auto added = store->transact([&](Transaction& transaction) -> Stored<void> {
    return Users(transaction).add(options.name, *role, *password, now).map([&](const User& user) {
      record(transaction, AuditKind::user,
             {{"action", "add"}, {"name", user.name}, {"role", role_name(user.role)}}, now);
    });
  });
  if (!added) {
    return tl::unexpected(failure_of(added.error()));
  }
  output << "added " << options.name << ", " << options.role << '\n';
  return {};
}

Result<void> change_password(const UserOptions& options, const Installation& installation,
                             std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const Result<PasswordHash> password = new_password(options);
  if (!password) {
    return tl::unexpected(password.error());
  }
  const UtcTime now = std::chrono::system_clock::now();
  const auto ended = store->transact([&](Transaction& transaction) -> Stored<std::size_t> {
    return Users(transaction)
        .change(options.name, {.role = {}, .password = *password, .enabled = {}})
        .map([&](const User& user) {
          const std::vector<Session> sessions = Sessions(transaction).end_all_of_user(user.name);
          record(transaction, AuditKind::user, {{"action", "password"}, {"name", user.name}}, now);
          for (const Session& session : sessions) {
            record(transaction, AuditKind::session_ended,
                   {{"session", session.number}, {"user", user.name}, {"reason", "password"}}, now);
          }
          return sessions.size();
        });
  });
  if (!ended) {
    return tl::unexpected(failure_of(ended.error()));
  }
  output << "changed the password of " << options.name << "; sessions ended: " << *ended << '\n';
  return {};
}

Result<void> list_users(const UserOptions& options, const Installation& installation, std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const auto users = store->read(
      [](Transaction& transaction) -> Stored<std::vector<User>> { return Users(transaction).list(); });
  if (!users) {
    return tl::unexpected(failure_of(users.error()));
  }
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    std::transform(users->begin(), users->end(), std::back_inserter(list),
                   [](const User& user) { return to_json(user); });
    // As ASCII: a terminal shows it, too.
    output << list.dump(2, ' ', true) << '\n';
    return {};
  }
  for (const User& user : *users) {
    output << std::left << std::setw(33) << printable(user.name) << std::setw(9) << role_name(user.role)
           << (user.enabled ? "enabled " : "disabled") << "  "
           << (user.last_login ? "last login " + iso_8601(*user.last_login) : "never logged in") << '\n';
  }
  return {};
}

}  // namespace interlock::cli
