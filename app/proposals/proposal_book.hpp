/**
 * @file
 * The book of proposals: drafts, checks, approves and follows them, newest 200 kept.
 *
 * Belongs to the network thread. The control thread carries the orders out; the book learns from each view
 * where they stand. A state that is final stays final, whatever a late report says.
 */
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

class ProposalBook {
 public:
  static constexpr std::size_t capacity = 200;

  /** Hands a command to the control thread; false when it takes none now. */
  using Send = std::function<bool(const Command&)>;
  /** Told of each proposal that changed. */
  using Listener = std::function<void(const Proposal&)>;
  using Clock = std::function<UtcTime()>;

  /** `robot` and `config` must outlive the book. */
  ProposalBook(const Robot& robot, const ilk_config_t& config, Send send, Clock clock);

  void on_change(Listener listener) { listener_ = std::move(listener); }

  /**
   * Drafts a move, checks it and approves it, as its author releases it by proposing it. An open proposal of
   * the same axis is aborted. A refused draft stays in the book.
   */
  tl::expected<Proposal, Refusal> propose(const MoveDraft& draft, const ControlView& view);

  /** Ends an open proposal; an executing one stops at once. The id must exist. */
  tl::expected<Proposal, Refusal> abort(std::uint32_t id);

  /** Ends every open proposal. The caller sees to it that the kernel stops. */
  void abort_all(const std::string& reason);

  /** Takes over where the control thread's orders stand. */
  void follow(const OrderTable& orders);

  /** The proposal of that number, or null. */
  [[nodiscard]] const Proposal* find(std::uint32_t id) const;

  /** The open proposal of the axis, or null. */
  [[nodiscard]] const Proposal* open_of(std::uint32_t slot) const;

  /** Newest first. */
  [[nodiscard]] std::vector<Proposal> newest_first() const { return {book_.rbegin(), book_.rend()}; }

 private:
  Proposal& draft(const Axis& axis, const MoveDraft& draft, std::uint32_t tick);
  void replace_open(std::uint32_t slot, std::uint32_t by);
  Refusal refuse(Proposal& proposal, Refusal refusal);
  void become(Proposal& proposal, ProposalState state, std::string detail,
              std::optional<std::string> verdict = std::nullopt);
  void follow(const OrderStatus& status);
  Proposal* find_mutable(std::uint32_t id);

  const Robot& robot_;
  const ilk_config_t& config_;
  Send send_;
  Clock clock_;
  Listener listener_ = [](const Proposal&) {};
  std::deque<Proposal> book_; /**< oldest first */
  std::uint32_t last_id_ = 0;
};

}  // namespace interlock
