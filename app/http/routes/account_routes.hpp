/**
 * @file
 * Routes of one's own account: login, logout, session and password.
 */
#pragma once

#include "http/context.hpp"
#include "http/login_guard.hpp"
#include "http/router.hpp"
#include "store/sessions.hpp"

namespace interlock::web {

class AccountRoutes {
 public:
  /** Both must outlive it. */
  AccountRoutes(const Context& context, Router& router);

 private:
  boost::asio::awaitable<Reply> login(const Call& call);
  boost::asio::awaitable<Reply> logout(const Call& call);
  boost::asio::awaitable<Reply> change_password(const Call& call);
  [[nodiscard]] Reply session(const Call& call) const;
  [[nodiscard]] tl::expected<void, Problem> need_no_wait(const std::string& name) const;
  boost::asio::awaitable<tl::expected<std::optional<Authenticated>, Problem>> authenticate(std::string name,
                                                                                           Password password);

  const Context& context_;
  LoginGuard guard_;
};

}  // namespace interlock::web
