/**
 * @file
 * Routes of the proposals.
 */
#pragma once

#include "http/context.hpp"
#include "http/proposing.hpp"
#include "http/router.hpp"

namespace interlock::web {

class ProposalRoutes {
 public:
  /** Both must outlive it. */
  ProposalRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply list() const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<Task, Problem>> task_of(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> propose(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> approve(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> reject(const Call& call) const;
  [[nodiscard]] Reply show(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> plan(const Call& call) const;
  [[nodiscard]] Reply abort(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
