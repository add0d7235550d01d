/**
 * @file
 * Routes of jogging: a move towards one end of an axis' range, held by renewals.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class JogRoutes {
 public:
  /** Both must outlive it. */
  JogRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> begin(const Call& call) const;
  [[nodiscard]] Reply renew(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
