#include "http/jog_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interlock/sim_bus.h"

namespace interlock::web {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr JogDesk::TimePoint start{};

ControlView attached_view() {
  ControlView view;
  view.attached = true;
  view.snapshot.clock = ILK_CLOCK_REAL;
  return view;
}

TEST(JogDesk, AJogLapsesWhenItIsNotRenewedInTime) {
  JogDesk desk;
  desk.begin(7, attached_view(), start);
  EXPECT_THAT(desk.lapsed(attached_view(), start + milliseconds(199)), IsEmpty());
  EXPECT_TRUE(desk.renew(7, attached_view(), start + milliseconds(150)));
  EXPECT_THAT(desk.lapsed(attached_view(), start + milliseconds(349)), IsEmpty());
  EXPECT_THAT(desk.lapsed(attached_view(), start + milliseconds(350)), ElementsAre(7u));
}

TEST(JogDesk, ALateRenewalBringsNoJogBack) {
  JogDesk desk;
  desk.begin(7, attached_view(), start);
  EXPECT_FALSE(desk.renew(7, attached_view(), start + milliseconds(200)));
  EXPECT_THAT(desk.lapsed(attached_view(), start + milliseconds(201)), ElementsAre(7u));
}

TEST(JogDesk, EachJogHasALeaseOfItsOwn) {
  JogDesk desk;
  desk.begin(7, attached_view(), start);
  desk.begin(8, attached_view(), start + milliseconds(100));
  EXPECT_THAT(desk.lapsed(attached_view(), start + milliseconds(200)), ElementsAre(7u));
  EXPECT_TRUE(desk.renew(8, attached_view(), start + milliseconds(200)));
  EXPECT_THAT(desk.running(), ElementsAre(7u, 8u));
  desk.end(7);
  EXPECT_THAT(desk.running(), ElementsAre(8u));
  EXPECT_FALSE(desk.renew(7, attached_view(), start + milliseconds(200)));
}

TEST(JogDesk, NothingIsRenewedThatNeverBegan) {
  JogDesk desk;
  EXPECT_FALSE(desk.renew(1, attached_view(), start));
  EXPECT_THAT(desk.lapsed(attached_view(), start + std::chrono::hours(1)), IsEmpty());
}

}  // namespace
}  // namespace interlock::web
