#include "store/first_admin.hpp"

#include "store/audit.hpp"
#include "store/users.hpp"

namespace interlock {

Stored<std::optional<Password>> add_first_admin(Store& store, UtcTime now) {
  const auto has_users =
      store.read([](Transaction& transaction) -> Stored<bool> { return !Users(transaction).list().empty(); });
  if (!has_users) {
    return tl::unexpected(has_users.error());
  }
  if (*has_users) {
    return std::nullopt;
  }
  Stored<Password> password = Password::random();
  if (!password) {
    return tl::unexpected(password.error());
  }
  const Stored<PasswordHash> hash = PasswordHash::of_new(*password, first_admin_name);
  if (!hash) {
    return tl::unexpected(hash.error());
  }
  const auto added = store.transact([&](Transaction& transaction) -> Stored<bool> {
    if (!Users(transaction).list().empty()) {
      return false;
    }
    return Users(transaction).add(first_admin_name, Role::admin, *hash, now).map([&](const User& user) {
      Audit(transaction)
          .append({now,
                   std::nullopt,
                   audit_actor::app,
                   std::nullopt,
                   AuditKind::user,
                   {{"action", "add"}, {"name", user.name}, {"role", role_name(user.role)}}});
      return true;
    });
  });
  if (!added) {
    return tl::unexpected(added.error());
  }
  return *added ? std::optional(std::move(*password)) : std::nullopt;
}

}  // namespace interlock
