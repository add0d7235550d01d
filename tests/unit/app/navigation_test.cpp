#include "service/navigation.hpp"

#include <cmath>
#include <memory>

#include "http_fixture.hpp"
#include "igtl/client.hpp"

namespace interlock::web {
namespace {

using igtl::StatusCode;

/** A navigation program on the app's port, in the dialect brp2013; the test is the kernel's side. */
class NavigationTest : public HttpTest {
 protected:
  NavigationTest() : NavigationTest(test::neuro()) {}

  explicit NavigationTest(const Robot& robot) : HttpTest(robot, test::neuro_config()) {
    in_network([this] {
      igtl::IgtlServerOptions options;
      options.port = 0;
      EXPECT_TRUE(api_.navigation().server().listen(options).has_value());
      api_.navigation().start({"brp2013", false, std::nullopt});
    });
    show(test::ready_view());
    EXPECT_TRUE(program_->connect("127.0.0.1", api_.navigation().server().port(), soon()).has_value());
    EXPECT_EQ(ask("WHO"), "ERROR 12") << "the connection is listed by now";
  }

  static igtl::Client::Deadline soon() { return std::chrono::steady_clock::now() + std::chrono::minutes(5); }

  void become_controller() {
    const json listed = json::parse(get("/api/communications/connections").body);
    const std::string path = "/api/communications/connections/" + listed[0]["id"].dump() + "/role";
    ASSERT_EQ(put(path, R"({"role":"controller"})").status, 200u);
  }

  void request(const std::string& phase) {
    EXPECT_TRUE(program_->send("CMD_1", igtl::Text{phase}, soon()).has_value());
  }

  /** The next message, other than ACK and CURRENT_STATUS: its name and code. */
  std::string next_answer() {
    for (;;) {
      const auto message = program_->receive(soon());
      if (!message || !*message) {
        return "nothing";
      }
      const auto* status = std::get_if<igtl::Status>(&(*message)->body);
      if (status != nullptr && (*message)->device != "CURRENT_STATUS") {
        return (*message)->device + " " + std::to_string(static_cast<int>(status->code));
      }
    }
  }

  std::string ask(const std::string& phase) {
    request(phase);
    return next_answer();
  }

  /** Sends a pose under a name that was not sent before, and gives its answer. */
  std::string send_pose(const std::string& prefix, const igtl::Matrix& pose) {
    const std::string name = prefix + std::to_string(++sent_poses_);
    EXPECT_TRUE(program_->send(name, igtl::Transform{pose}, soon()).has_value());
    return next_answer();
  }

  std::string calibrate(float x_mm) {
    return send_pose("CLB_", {1, 0, 0, x_mm, 0, 1, 0, -185, 0, 0, 1, -73});
  }

  int sent_poses_ = 0;
  std::unique_ptr<igtl::Client> program_ = std::make_unique<igtl::Client>();
};

TEST_F(NavigationTest, StopIsAskedForOnceAndAnsweredWhenTheKernelHasAccepted) {
  request("STOP");
  while (channel_->stops == 0) {
    std::this_thread::yield();
  }
  EXPECT_EQ(channel_->stops, 1u);
  answer(StopAnswer{1, ILK_VERDICT_ACCEPTED, 6});
  EXPECT_EQ(next_answer(), "STOP 1");
}

TEST_F(NavigationTest, AnyFrameThatIsNamedStopStopsThoughItCannotBeRead) {
  tcp::socket socket(client_);
  socket.connect({asio::ip::make_address("127.0.0.1"), api_.navigation().server().port()});
  const igtl::ByteVector some(8, 1);
  const auto wrong_checksum = [&] {
    auto frame = igtl::write_frame(1, "STRING", "STOP", 0, some);
    frame.back() = 2;
    return frame;
  };
  const std::vector<igtl::ByteVector> frames{
      igtl::write_frame(1, "WORD", "STOP", 0, some),          igtl::write_frame(2, "WORD", "STOP", 0, some),
      igtl::write_frame(1, "TRANSFORM", "STOP", 0, some),     igtl::write_frame(1, "STRING", "stop", 0, some),
      igtl::write_frame(1, "GET_STATUS", "EMERGENCY", 0, {}), wrong_checksum()};
  std::uint32_t sent = 0;
  for (const igtl::ByteVector& frame : frames) {
    asio::write(socket, asio::buffer(frame));
    ++sent;
    while (channel_->stops != sent) {
      std::this_thread::yield();
    }
  }
}

TEST_F(NavigationTest, AHeaderThatIsNamedStopStopsThoughNothingElseOfItCanBeReadOrItsBodyNeverComes) {
  const igtl::ByteVector whole = igtl::write_frame(1, "STRING", "STOP", 0, igtl::ByteVector(8, 1));
  const auto overwritten = [&](std::size_t at, std::size_t count, std::uint8_t byte) {
    auto frame = whole;
    std::fill_n(frame.begin() + static_cast<std::ptrdiff_t>(at), count, byte);
    return frame;
  };
  const std::vector<igtl::ByteVector> frames{
      overwritten(2, igtl::type_width, 0), overwritten(2, igtl::type_width, 0xff), overwritten(0, 2, 9),
      overwritten(42, 8, 0xff), igtl::ByteVector(whole.begin(), whole.end() - 1)};
  std::uint32_t sent = 0;
  for (const igtl::ByteVector& frame : frames) {
    tcp::socket socket(client_);
    socket.connect({asio::ip::make_address("127.0.0.1"), api_.navigation().server().port()});
    asio::write(socket, asio::buffer(frame));
    socket.shutdown(tcp::socket::shutdown_send);
    ++sent;
    while (channel_->stops != sent) {
      std::this_thread::yield();
    }
  }
}

TEST_F(NavigationTest, TheAuditNamesWhoseProgramStoppedTheRobotAndWhoEndedAProposal) {
  constexpr const char* move = R"({"slot":3,"target_counts":1000})";
  ASSERT_EQ(post("/api/proposals", move).status, 201u);
  (void)ask("EMERGENCY");
  become_controller();
  ASSERT_EQ(post("/api/proposals", move).status, 201u);
  (void)ask("STOP");
  pass(StopRecords::pause);
  while (audit("stop").size() < 2) {
    std::this_thread::yield();
  }
  std::vector<AuditRecord> stops;
  std::vector<AuditRecord> ended;
  for (const AuditRecord& record : audit()) {
    if (record.kind == "stop") {
      stops.push_back(record);
    } else if (record.kind == "proposal" && json::parse(record.detail)["state"] == "aborted") {
      ended.push_back(record);
    }
  }
  ASSERT_EQ(stops.size(), 2u);
  ASSERT_EQ(ended.size(), 2u);
  for (const AuditRecord& each : stops) {
    EXPECT_THAT(json::parse(each.detail)["peer"].get<std::string>(), testing::StartsWith("openigtlink 127."));
    EXPECT_EQ(each.tick, 1000);
  }
  EXPECT_EQ(stops[0].actor, "nobody") << "an observer acts for nobody";
  EXPECT_EQ(stops[1].actor, "edna") << "the controller acts for her";
  EXPECT_TRUE(stops[1].session.has_value());
  EXPECT_EQ(ended[0].actor, "nobody");
  EXPECT_THAT(json::parse(ended[0].detail)["detail"].get<std::string>(),
              testing::StartsWith("STOP by openigtlink 127."));
  EXPECT_EQ(json::parse(ended[0].detail)["author"], "edna");
}

TEST_F(NavigationTest, AProgramCannotSendATargetOfBeforeTheTableMoved) {
  become_controller();
  EXPECT_EQ(ask("START_UP"), "START_UP 1");
  const auto registered_at = [this](float x_mm) {
    request("CALIBRATION");
    ASSERT_EQ(calibrate(x_mm), "CALIBRATION 1");
    ASSERT_EQ(ask("TARGETING"), "TARGETING 1");
  };
  const auto aim = [this](float x_mm) {
    return send_pose("TGT_", {1, 0, 0, x_mm, 0, 0, -1, 15, 0, 1, 0, -13});
  };
  registered_at(-18.0f);
  EXPECT_EQ(aim(-10.0f), "TARGET 1");
  EXPECT_EQ(aim(-11.0f), "TARGET 1");
  EXPECT_EQ(aim(-10.0f), "TARGET 1") << "nothing has moved";
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  registered_at(-25.0f);
  EXPECT_NE(aim(-10.0f), "TARGET 1");
  EXPECT_NE(aim(-10.05f), "TARGET 1") << "rounded";
  EXPECT_EQ(json::parse(get("/api/targeting").body)["target_point"], json());
  EXPECT_EQ(aim(-16.0f), "TARGET 1") << "a new one";
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  registered_at(-21.0f);
  EXPECT_NE(aim(-10.0f), "TARGET 1") << "however often it moved since";
  ASSERT_EQ(
      put("/api/targeting/target", R"({"entry_point":[-10,65,-13],"target_point":[-10,15,-13]})").status,
      200u);
  EXPECT_EQ(aim(-10.0f), "TARGET 1") << "a person has said that it holds";
}

TEST_F(NavigationTest, AProgramCannotRenewARegistrationThatHasExpired) {
  become_controller();
  EXPECT_EQ(ask("START_UP"), "START_UP 1");
  request("CALIBRATION");
  const auto state = [this] { return json::parse(get("/api/targeting").body)["registration_state"]; };
  EXPECT_EQ(calibrate(5.0f), "CALIBRATION 1");
  EXPECT_EQ(state(), "valid");
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  EXPECT_NE(calibrate(5.0f), "CALIBRATION 1");
  EXPECT_EQ(state(), "expired");
  for (const float nearly : {5.01f, 3.2f, 6.9f}) {
    EXPECT_NE(calibrate(nearly), "CALIBRATION 1") << "rounded, or with the noise of a tracker";
  }
  EXPECT_EQ(state(), "expired");
  EXPECT_EQ(calibrate(8.0f), "CALIBRATION 1") << "a new one";
  EXPECT_EQ(state(), "valid");
  EXPECT_NE(calibrate(5.0f), "CALIBRATION 1") << "the one before has still expired";
  register_robot();
  EXPECT_EQ(calibrate(8.0f), "CALIBRATION 1") << "nobody said that it does not hold";
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  register_robot();
  EXPECT_NE(calibrate(8.0f), "CALIBRATION 1") << "it was replaced, and then the table moved";
  for (int other = 0; other < 25; ++other) {
    EXPECT_EQ(calibrate(-40.0f - 2.5f * static_cast<float>(other)), "CALIBRATION 1") << other;
    ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  }
  EXPECT_NE(calibrate(5.0f), "CALIBRATION 1") << "however long ago that was";
  EXPECT_EQ(calibrate(20.0f), "CALIBRATION 1");
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  EXPECT_EQ(calibrate(22.5f), "CALIBRATION 1");
  EXPECT_EQ(calibrate(23.0f), "CALIBRATION 1") << "it corrects itself";
  for (const float step : {21.5f, 20.0f}) {
    EXPECT_NE(calibrate(step), "CALIBRATION 1") << "towards the one before, through what is new";
  }
  ASSERT_EQ(post("/api/cases/1/close").status, 200u);
  EXPECT_NE(calibrate(30.0f), "CALIBRATION 1") << "no case is open";
  ASSERT_EQ(post("/api/cases", R"({"label":"the next"})").status, 201u);
  for (const float of_the_case_before : {5.0f, 20.0f}) {
    EXPECT_NE(calibrate(of_the_case_before), "CALIBRATION 1");
  }
  EXPECT_EQ(state(), "not_set");
  EXPECT_EQ(calibrate(11.0f), "CALIBRATION 1");
  const std::string holder = std::exchange(token_, token_of("ada"));
  for (const char* number : {"1", "2"}) {
    (void)post("/api/cases/" + std::string(number) + "/close");
    ASSERT_EQ(send({http::verb::delete_, "/api/cases/" + std::string(number), 11}).status, 200u);
  }
  token_ = holder;
  ASSERT_EQ(post("/api/cases", R"({"label":"after them"})").status, 201u);
  for (const float of_a_case_that_was_deleted : {8.0f, 11.0f}) {
    EXPECT_NE(calibrate(of_a_case_that_was_deleted), "CALIBRATION 1");
  }
}

TEST_F(NavigationTest, AStopThatNoKernelConfirmsIsNotSaidToBeDone) {
  EXPECT_EQ(ask("STOP"), "STOP 13");
  EXPECT_EQ(channel_->stops, 1u);
}

TEST_F(NavigationTest, ManualDisablesEveryAxisForTheControllerAlone) {
  EXPECT_EQ(ask("MANUAL"), "MANUAL 5");
  become_controller();
  request("MANUAL");
  for (std::size_t i = 0; i < test::neuro().axes.size(); ++i) {
    EXPECT_EQ(accept_next(), ILK_REQUEST_DISABLE);
  }
  EXPECT_EQ(next_answer(), "MANUAL 1");
}

TEST_F(NavigationTest, AHomedRobotHasStartedUp) {
  become_controller();
  ControlView view = test::ready_view();
  for (const Axis& axis : test::neuro().axes) {
    view.snapshot.state.axis[axis.slot].homed = 1;
  }
  show(view);
  EXPECT_EQ(ask("START_UP"), "START_UP 1");
  EXPECT_EQ(json::parse(get("/api/proposals").body), json::array());
}

/** Of a robot whose axes are homed one by one. */
class NavigationWithoutHomeStepsTest : public NavigationTest {
 protected:
  NavigationWithoutHomeStepsTest() : NavigationTest(without_steps()) {}

  static const Robot& without_steps() {
    static const Robot robot = [] {
      Robot changed = test::neuro();
      changed.home_steps.clear();
      return changed;
    }();
    return robot;
  }
};

TEST_F(NavigationWithoutHomeStepsTest, ItHasStartedUpOnceEveryAxisIsHomed) {
  become_controller();
  ControlView view = test::ready_view();
  view.snapshot.state.axis[test::insertion].homed = 0;
  show(view);
  EXPECT_EQ(ask("START_UP"), "START_UP 13");
  show(test::ready_view());
  EXPECT_EQ(ask("START_UP"), "START_UP 1");
  EXPECT_EQ(json::parse(get("/api/proposals").body), json::array());
}

TEST_F(NavigationTest, AConsoleIsToldOfConnectionsRolesAndTheirEnd) {
  auto stream = open_stream();
  igtl::Client other;
  ASSERT_TRUE(other.connect("127.0.0.1", api_.navigation().server().port(), soon()).has_value());
  json told = stream.next_text("connection");
  while (told["connection"] != "openigtlink") {
    told = stream.next_text("connection");
  }
  const json id = told["id"];
  EXPECT_EQ(told["change"], "opened");
  EXPECT_EQ(told["role"], "observer");
  become_controller();
  told = stream.next_text("connection");
  EXPECT_EQ(told["change"], "role");
  EXPECT_EQ(told["role"], "controller");
  EXPECT_NE(told["id"], id);
  EXPECT_EQ(post("/api/control/release").status, 200u);
  told = stream.next_text("connection");
  EXPECT_EQ(told["change"], "role");
  EXPECT_EQ(told["role"], "observer");
  const std::string path = "/api/communications/connections/" + id.dump();
  ASSERT_EQ(send(Request{http::verb::delete_, path, 11}).status, 200u);
  told = stream.next_text("connection");
  EXPECT_EQ(told["change"], "closed");
  EXPECT_EQ(told["id"], id);
  EXPECT_NE(told["reason"].get<std::string>().find("disconnected by"), std::string::npos);
}

TEST_F(NavigationTest, TheLossOfTheControllerPausesAndIsNoStop) {
  become_controller();
  program_.reset();
  while (channel_->pauses == 0) {
    std::this_thread::yield();
  }
  EXPECT_EQ(channel_->stops, 0u) << "a STOP would end every order";
}

TEST(PoseVelocity, IsThatOfTranslationAndRotation) {
  const double angle = 0.02;
  const igtl::Matrix before{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1};
  const igtl::Matrix after{std::cos(angle),
                           -std::sin(angle),
                           0,
                           5.5,
                           std::sin(angle),
                           std::cos(angle),
                           0,
                           6,
                           0,
                           0,
                           1,
                           6,
                           0,
                           0,
                           0,
                           1};
  PoseVelocity velocity;
  velocity.measure(1000, 1000, before);
  EXPECT_FALSE(velocity.per_s().has_value());
  velocity.measure(1100, 1000, after);
  const std::array<double, 6> expected{5, 0, -10, 0, 0, 0.2};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(velocity.per_s().value()[i], expected[i], 1e-9) << i;
  }
  velocity.measure(1100, 1000, after);
  EXPECT_FALSE(velocity.per_s().has_value()) << "no time went by";
  velocity.measure(1200, 1000, std::nullopt);
  EXPECT_FALSE(velocity.per_s().has_value());
}

TEST_F(NavigationTest, TheRoleEndsWithControl) {
  become_controller();
  EXPECT_EQ(post("/api/control/release").status, 200u);
  EXPECT_EQ(ask("START_UP"), "START_UP 5");
}

}  // namespace
}  // namespace interlock::web
