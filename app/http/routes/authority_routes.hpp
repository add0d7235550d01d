/**
 * @file
 * Routes of the motion authority.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class AuthorityRoutes {
 public:
  /** Both must outlive it. */
  AuthorityRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> request(const Call& call) const;
  [[nodiscard]] Reply release(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> hand_over(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> take_over(const Call& call) const;
  [[nodiscard]] Success shown(const Call& call, Status status = Status::ok) const;
  /** 409 REPLAY where nothing could move. */
  [[nodiscard]] tl::expected<void, Problem> need_robot() const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<void, Problem>> announce(const Call& call,
                                                                             const char* action) const;

  const Context& context_;
};

}  // namespace interlock::web
