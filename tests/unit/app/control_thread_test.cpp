#include <gtest/gtest.h>

#include "control_loop_fixture.hpp"
#include "counted_allocations.hpp"

namespace interlock {
namespace {

class ControlThread : public test::ControlLoopTest {};

TEST_F(ControlThread, AllocatesNothingWhileItTicks) {
  tick();
  test::count_allocations_of(thread_.native_handle());
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  for (std::uint32_t i = 1; i <= 200; ++i) {
    approve(i, MoveTask{test::insertion, static_cast<std::int32_t>(i)}, i / 50);
    approve(1000 + i, HomeTask{0, 3, {}}, i / 50);
    command(ask(i, ILK_REQUEST_ENABLE));
    if (i % 50 == 0) {
      stop();
    }
    tick();
    for (const ilk_request_t& request : requests_) {
      kernel_.push_verdict(request, ILK_VERDICT_RANGE, i);
    }
    kernel_.push_event({0, ILK_EVENT_AXIS, i, {}});
    (void)notices<KernelResponse>();
  }
  EXPECT_EQ(test::counted_allocations(), 0u);
  test::count_allocations_of();
}

}  // namespace
}  // namespace interlock
