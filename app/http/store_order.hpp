/**
 * @file
 * What somebody who waits and the store's thread agree upon about one piece of work: either it is committed
 * or it is given up, never both.
 */
#pragma once

#include <atomic>

namespace interlock::web {

class StoreOrder {
 public:
  /** Whether nobody waits for it any more: it is not to be begun, and must not be committed. */
  [[nodiscard]] bool abandoned() const { return state_.load() == State::abandoned; }

  /** The store is about to commit; false when nobody waits for it any more. */
  bool begin_commit() {
    State open = State::open;
    return state_.compare_exchange_strong(open, State::committing) || open == State::committing;
  }

  /** Nobody waits for it any more; false when it is being committed already. */
  bool abandon() {
    State open = State::open;
    return state_.compare_exchange_strong(open, State::abandoned) || open == State::abandoned;
  }

 private:
  enum class State { open, committing, abandoned };

  std::atomic<State> state_ = State::open;
};

}  // namespace interlock::web
