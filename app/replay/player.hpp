/**
 * @file
 * Shows a recording on the link, tick by tick, at the pace at which it was recorded.
 */
#pragma once

#include <csignal>

#include "clock.h"
#include "interlock/link.h"
#include "interlock/recorded_block.h"
#include "interlock/recording.h"
#include "link_mailbox.h"
#include "publisher.h"

namespace interlock {

/** Stands where the kernel's loop stands. What an app asks is not read. */
class Player {
 public:
  /**
   * `channel` and `stop` must outlive it.
   *
   * @param speed multiple of the recorded pace, above 0
   * @param stop ends all waiting when it is not 0
   */
  Player(const ilk_run_description_t& run, double speed, ilk_link_mailbox_t& channel,
         const volatile std::sig_atomic_t& stop);

  /** Waits until an app has attached, so that it sees the recording from its beginning. */
  void wait_for_app();

  /** Publishes a tick when it is due. */
  void show(const ilk_recorded_tick_t& tick);

  /** Keeps the newest tick in sight, for apps that attach later, too, until it is stopped. */
  void hold();

  /** The attachment that is served, for the link's server to destroy; NULL when there is none. */
  [[nodiscard]] ilk_attachment_t* attachment() const { return attachment_; }

 private:
  void begin(const ilk_state_t& state);
  void serve_newest_app();
  void publish();

  ilk_link_mailbox_t& channel_;
  const volatile std::sig_atomic_t& stop_;
  double speed_;
  bool begun_ = false;
  ilk_ticker_t ticker_{};
  ilk_attachment_t* attachment_ = nullptr;
  ilk_publisher_t publisher_{};
  ilk_snapshot_t shown_{};
  ilk_outputs_t out_{};
};

}  // namespace interlock
