/**
 * @file
 * Routes of one's own account: login, logout, sessions and password. Administrators see and end the sessions
 * of others, too.
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
  [[nodiscard]] nlohmann::json listed(const Session& session, const Caller& caller) const;
  boost::asio::awaitable<Reply> sessions(const Call& call);
  boost::asio::awaitable<Reply> end_session(const Call& call);
  tl::expected<LoginGuard::Attempt, Problem> begin_attempt(const Call& call, const std::string& name);
  [[nodiscard]] boost::asio::awaitable<void> pause(std::chrono::seconds time) const;
  boost::asio::awaitable<tl::expected<std::optional<Authenticated>, Problem>> authenticate(std::string name,
                                                                                           Password password);

  const Context& context_;
  LoginGuard guard_;
};

}  // namespace interlock::web
