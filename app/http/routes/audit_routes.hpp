/**
 * @file
 * Routes of the audit.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class AuditRoutes {
 public:
  /** Both must outlive it. */
  AuditRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> records(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> verify(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
