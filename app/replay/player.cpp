#include "replay/player.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>

namespace interlock {
namespace {

constexpr std::chrono::milliseconds pause_between_looks{10};

}  // namespace

Player::Player(const ilk_run_description_t& run, double speed, ilk_link_mailbox_t& channel,
               const volatile std::sig_atomic_t& stop)
    : channel_(channel), stop_(stop), speed_(speed) {
  shown_.clock = run.clock;
  shown_.simulated = run.simulated;
  shown_.period_us = run.config.common.period_us;
  shown_.config_crc = run.config.crc;
}

void Player::wait_for_app() {
  while (stop_ == 0 && attachment_ == nullptr) {
    serve_newest_app();
    std::this_thread::sleep_for(pause_between_looks);
  }
}

void Player::show(const ilk_recorded_tick_t& tick) {
  if (stop_ != 0) {
    return;
  }
  const ilk_picture_t& picture = tick.picture;
  if (!begun_) {
    begin(picture.state);
  }
  ilk_sleep_until(ilk_ticker_next(&ticker_, true, ilk_now_ns()));
  shown_.state = picture.state;
  shown_.inputs = picture.inputs;
  shown_.overruns = picture.state.system.overruns;
  std::ranges::copy(picture.out.command, std::begin(shown_.command));
  std::ranges::copy(picture.out.gate, std::begin(shown_.gate));
  shown_.power = picture.out.power;
  std::ranges::copy(picture.out.lamp, std::begin(shown_.lamp));
  out_ = picture.out;
  publish();
}

void Player::hold() {
  out_.verdict_count = 0;
  while (stop_ == 0) {
    publish();
    std::this_thread::sleep_for(pause_between_looks);
  }
}

/** What was so before the first tick is no news: its events count from there, and so does the pace. */
void Player::begin(const ilk_state_t& state) {
  ilk_publisher_init(&publisher_, &state);
  ilk_publisher_attach(&publisher_, attachment_ != nullptr ? attachment_->regions.kernel : nullptr);
  ilk_ticker_init(&ticker_, ILK_CLOCK_SIM, shown_.period_us, speed_, ilk_now_ns());
  begun_ = true;
}

void Player::serve_newest_app() {
  ilk_attachment_t* const newest = ilk_mailbox_exchange(&channel_, attachment_);
  if (newest != attachment_) {
    attachment_ = newest;
    ilk_publisher_attach(&publisher_, newest != nullptr ? newest->regions.kernel : nullptr);
  }
}

void Player::publish() {
  serve_newest_app();
  ilk_publisher_publish(&publisher_, &shown_, &out_, 0);
}

}  // namespace interlock
