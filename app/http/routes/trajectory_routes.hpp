/**
 * @file
 * Routes of the trajectory that is loaded.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class TrajectoryRoutes {
 public:
  static constexpr const char* path = "/api/trajectory";

  /** Both must outlive it. */
  TrajectoryRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> load(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> unload(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
