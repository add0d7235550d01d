/**
 * @file
 * Routes of what has been, for plots: decimated, and tick by tick from the kernel's black box.
 */
#pragma once

#include <filesystem>

#include "history/capture.hpp"
#include "history/history.hpp"
#include "history/history_feed.hpp"
#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

/** What is known of former ticks. */
struct Past {
  HistoryFeed* feed = nullptr;     /**< must outlive what is given it; null: nothing is decimated */
  std::filesystem::path black_box; /**< socket of the kernel's; empty: there is none to read */
};

/** `GET /api/history` and `GET /api/capture`, and what they read: the decimated past and the black box. */
class HistoryRoutes {
 public:
  /** Context and router must outlive it. */
  HistoryRoutes(const Context& context, Past past, Router& router);

  /** Takes over what was decimated since the last call; at least once a second. */
  void keep();

 private:
  [[nodiscard]] Reply history(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> capture(const Call& call) const;

  /** Gives the span what velocity and forces are found by. */
  void add_rules(CaptureSpan& span) const;

  [[nodiscard]] std::optional<ForceScales> force_scales() const;

  const Context& context_;
  Past past_;
  History history_;
};

}  // namespace interlock::web
