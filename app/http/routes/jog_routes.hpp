/**
 * @file
 * Routes of jogging: a move towards one end of an axis' range, held by renewals.
 */
#pragma once

#include "http/context.hpp"
#include "http/jog_desk.hpp"
#include "http/router.hpp"

namespace interlock::web {

class JogRoutes {
 public:
  /** All must outlive it. */
  JogRoutes(const Context& context, JogDesk& jogs, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> begin(const Call& call) const;
  [[nodiscard]] Reply renew(const Call& call) const;

  const Context& context_;
  JogDesk& jogs_;
};

}  // namespace interlock::web
