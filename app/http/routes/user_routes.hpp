/**
 * @file
 * Routes by which administrators keep the users.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class UserRoutes {
 public:
  /** Both must outlive it. */
  UserRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> add(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> change(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
