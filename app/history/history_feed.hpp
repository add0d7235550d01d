/**
 * @file
 * Decimates on the control thread and hands over to the network thread, which neither ever waits for.
 */
#pragma once

#include <boost/lockfree/spsc_queue.hpp>

#include "history/decimation.hpp"
#include "motion/tick_observer.hpp"

namespace interlock {

class HistoryFeed : public TickObserver {
 public:
  explicit HistoryFeed(const RobotPlan& plan) : decimation_(plan) {}

  /** Control thread. */
  void see(const ControlView& view) noexcept override {
    if (const auto bucket = decimation_.take(view.generation, view.snapshot, view.force)) {
      (void)buckets_.push(*bucket);
    }
  }

  /** Network thread: hands over what came since the last call, oldest first. */
  template <typename Take>
  void take(Take take) {
    buckets_.consume_all(take);
  }

 private:
  /** Two seconds; what nobody takes by then is lost, and the ticks of the buckets tell. */
  static constexpr std::size_t capacity = 64;

  Decimation decimation_;
  boost::lockfree::spsc_queue<TickBucket, boost::lockfree::capacity<capacity>> buckets_;
};

}  // namespace interlock
