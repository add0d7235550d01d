/**
 * @file
 * Routes of registration, entry, target and probe.
 */
#pragma once

#include <functional>

#include "http/context.hpp"
#include "http/router.hpp"
#include "http/targeting.hpp"

namespace interlock::web {

class TargetingRoutes {
 public:
  /** Both must outlive it. */
  TargetingRoutes(const Context& context, Router& router);

 private:
  /** What a body makes of the values before. */
  using Change = tl::expected<Targeting, Problem> (*)(Targeting, const nlohmann::json&);

  void add_change(Router& router, const char* path, Change make);
  [[nodiscard]] boost::asio::awaitable<Reply> show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_alignment() const;
  [[nodiscard]] boost::asio::awaitable<Reply> change(const Call& call, Change make) const;

  const Context& context_;
};

}  // namespace interlock::web
