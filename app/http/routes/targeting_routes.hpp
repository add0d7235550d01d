/**
 * @file
 * Routes of registration, entry, target and probe.
 */
#pragma once

#include <functional>

#include "http/context.hpp"
#include "http/router.hpp"
#include "http/targeting_change.hpp"

namespace interlock::web {

class TargetingRoutes {
 public:
  /** Both must outlive it. */
  TargetingRoutes(const Context& context, Router& router);

 private:
  void add_change(Router& router, const char* path, TargetingChange make);
  [[nodiscard]] boost::asio::awaitable<Reply> show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_alignment() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_history() const;
  [[nodiscard]] boost::asio::awaitable<Reply> change(const Call& call, TargetingChange make) const;

  const Context& context_;
};

}  // namespace interlock::web
