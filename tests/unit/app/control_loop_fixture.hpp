/**
 * @file
 * The control thread on one side, the test as kernel and as network on the other, in lockstep by `seen_tick`.
 */
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stop_token>
#include <thread>
#include <vector>

#include "kernel_side.hpp"
#include "motion/control_loop.hpp"
#include "proposals/motion_kind.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock::test {

class ControlLoopTest : public testing::Test {
 protected:
  explicit ControlLoopTest(LinkUse use = LinkUse::control)
      : loop_(kernel_.socket(), make_modes(RobotPlan(neuro(), neuro_config())), LinkageWatch(neuro()),
              *channel_, nullptr, use),
        snapshot_(ready_view().snapshot) {
    thread_ = std::jthread([this](const std::stop_token& stop) { loop_.run(stop); });
    kernel_.accept();
  }

  /** Publishes the next tick and waits until the control thread has handled it; its requests are then in
   * `requests_`. */
  void tick(std::uint32_t ticks = 1) {
    snapshot_.state.system.tick += ticks;
    kernel_.publish(snapshot_);
    while (__atomic_load_n(&kernel_.app().seen_tick, __ATOMIC_ACQUIRE) != snapshot_.state.system.tick) {
      std::this_thread::yield();
    }
    requests_.clear();
    while (const auto request = kernel_.take_request()) {
      requests_.push_back(*request);
    }
  }

  [[nodiscard]] const ilk_request_t* sent(std::uint32_t kind) const {
    for (const ilk_request_t& request : requests_) {
      if (request.kind == kind) {
        return &request;
      }
    }
    return nullptr;
  }

  template <typename T>
  std::vector<T> notices() {
    std::vector<T> found;
    channel_->notices.consume_all([&](const Notice& notice) {
      if (const auto* desired = std::get_if<T>(&notice)) {
        found.push_back(*desired);
      }
    });
    return found;
  }

  void approve(std::uint32_t id, Work work, std::uint32_t stops = 0, Moment held = {}) {
    command(approval_of(id, std::move(work), stops, held));
  }

  void command(const Command& command) { ASSERT_TRUE(channel_->commands.push(command)); }

  /** Three more events than the ring holds, so that whatever was in it is lost. */
  void lose_events() {
    for (std::uint32_t i = 0; i < ILK_LINK_EVENTS + 3; ++i) {
      kernel_.push_event({0, ILK_EVENT_MODE, i, {}});
    }
  }

  static KernelCall ask(std::uint32_t call_id, std::uint32_t kind) {
    return {call_id, kind, insertion, 0, std::chrono::steady_clock::now() + std::chrono::hours(1)};
  }

  TaskStatus move() { return channel_->view.newest().tasks.move(insertion); }
  TaskStatus home() { return channel_->view.newest().tasks.of<HomeTask>(); }

  void stop() { channel_->stops.fetch_add(1, std::memory_order_release); }

  KernelSide kernel_;
  std::unique_ptr<RealtimeChannel> channel_ = std::make_unique<RealtimeChannel>();
  ControlLoop loop_;
  ilk_snapshot_t snapshot_;
  std::vector<ilk_request_t> requests_;
  std::jthread thread_;
};

}  // namespace interlock::test
