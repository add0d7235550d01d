/**
 * @file
 * What the route groups work with. Everything in it belongs to the network thread.
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <string>

#include "http/bench.hpp"
#include "http/control_client.hpp"
#include "http/message.hpp"
#include "http/stream_hub.hpp"
#include "proposals/proposal_book.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

struct Context {
  boost::asio::any_io_executor executor;
  const Robot& robot;
  const ilk_config_t& config;
  ControlClient& control;
  ProposalBook& book;
  StreamHub& stream;
  Bench& bench;

  /** The newest view; what it says of orders is in the book already. The reference holds until the next
   * call. */
  [[nodiscard]] const ControlView& view() const;

  /** 503 NO_KERNEL unless a kernel is connected. */
  [[nodiscard]] tl::expected<void, Problem> need_kernel() const;

  /**
   * Sends one request to the kernel and answers with its verdict: `VerdictAnswer`, 409 with the verdict as
   * code, or 503 NO_KERNEL.
   *
   * @param where what was asked of what, for the problem's detail
   */
  [[nodiscard]] boost::asio::awaitable<Reply> ask_kernel(std::uint32_t kind, std::uint32_t slot,
                                                         std::string where) const;
};

}  // namespace interlock::web
