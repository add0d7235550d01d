#include <boost/asio/detached.hpp>
#include <boost/asio/read.hpp>
#include <tuple>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using test::insertion;
using testing::HasSubstr;

TEST_F(HttpTest, AnUnknownPathIsAProblem) {
  const Answered answered = get("/api/nothing");
  EXPECT_EQ(answered.status, 404u);
  EXPECT_EQ(answered.problem()["code"], "NOT_FOUND");
  EXPECT_EQ(get("/nothing").problem()["code"], "NOT_FOUND");
}

TEST_F(HttpTest, AWrongMethodNamesTheRightOne) {
  const Answered answered = get("/api/stop");
  EXPECT_EQ(answered.status, 405u);
  EXPECT_EQ(answered.headers[http::field::allow], "POST");
  EXPECT_EQ(answered.problem()["code"], "METHOD_NOT_ALLOWED");
  EXPECT_EQ(send({http::verb::delete_, "/api/proposals", 11}).headers[http::field::allow], "GET, POST");
}

TEST_F(HttpTest, ABodyThatIsNoJsonIsMalformed) {
  for (const std::string body : {"", "{", "{\"slot\":3,}", "\xff", "[1,", "{\"target\":1e999}"}) {
    const Answered answered = post("/api/proposals", body);
    EXPECT_EQ(answered.status, 400u) << body;
    EXPECT_EQ(answered.problem()["code"], "MALFORMED") << body;
  }
}

TEST_F(HttpTest, AWrongFieldIsNamedWithWhatWasExpected) {
  const std::pair<std::string, std::string> cases[] = {
      {R"({"target":1})", "slot"},
      {R"({"slot":"3x","target":1})", "slot"},
      {R"({"slot":10,"target":1})", "slot"},
      {R"({"slot":-1,"target":1})", "slot"},
      {R"({"slot":3.5,"target":1})", "slot"},
      {R"({"slot":18446744073709551615,"target":1})", "slot"},
      {R"({"slot":null,"target":1})", "slot"},
      {R"({"slot":3})", "target"},
      {R"({"slot":3,"target":1,"target_counts":1})", "target"},
      {R"({"slot":3,"target":"1 mm"})", "target"},
      {R"({"slot":3,"target":1e300})", "target"},
      {R"({"slot":3,"target_counts":2147483648})", "target_counts"},
      {R"({"slot":3,"target_counts":1.5})", "target_counts"},
      {R"({"slot":3,"target":1,"drive":0})", "drive"},
      {R"({"slot":3,"target":1,"drive":true})", "drive"},
      {R"({"slot":3,"target":1,"speed":1})", "speed"}};
  for (const auto& [body, field] : cases) {
    const Answered answered = post("/api/proposals", body);
    EXPECT_EQ(answered.status, 422u) << body;
    const json problem = answered.problem();
    EXPECT_EQ(problem["code"], "INVALID") << body;
    EXPECT_EQ(problem["field"], field) << body;
    EXPECT_FALSE(problem["expected"].get<std::string>().empty()) << body;
  }
  EXPECT_EQ(post("/api/proposals", "[]").status, 422u);
}

TEST_F(HttpTest, AWholeNumberMayBeWrittenWithAPoint) {
  show(test::ready_view());
  EXPECT_EQ(post("/api/proposals", R"({"slot":3.0,"target_counts":1e3})").status, 201u);
}

TEST_F(HttpTest, AnEmptySlotIsNotFound) {
  show(test::ready_view());
  EXPECT_EQ(post("/api/proposals", R"({"slot":5,"target":1})").status, 404u);
  for (const std::string slot : {"5", "10", "-1", "x", "3x", "99999999999", ""}) {
    EXPECT_EQ(get("/api/motors/" + slot).status, 404u) << slot;
    EXPECT_EQ(post("/api/motors/" + slot + "/enable").status, 404u) << slot;
  }
  EXPECT_EQ(post("/api/motors/3/explode").status, 404u);
}

TEST_F(HttpTest, ABodyThatIsTooLargeIsRefusedAndTheServerGoesOn) {
  const Answered answered = post("/api/proposals", std::string(1u << 20u, ' '));
  EXPECT_EQ(answered.status, 413u);
  EXPECT_EQ(answered.problem()["code"], "TOO_LARGE");
  EXPECT_EQ(get("/api/status").status, 200u);
}

TEST_F(HttpTest, AHeaderThatIsTooLargeIsRefused) {
  Request request{http::verb::get, "/api/status", 11};
  request.set("X-Long", std::string(20000, 'x'));
  EXPECT_EQ(send(request).status, 431u);
}

TEST_F(HttpTest, WhatIsNoHttpGetsAnAnswer) {
  EXPECT_EQ(post_raw("HELLO\r\n\r\n").status, 400u);
  EXPECT_EQ(post_raw("POST /api/stop HTTP/1.1\r\nHost: x\r\nContent-Length: x\r\n\r\n").status, 400u);
}

/** Everything that the server sends until it closes the connection. */
std::string all_answers(tcp::socket socket, const std::string& bytes) {
  asio::write(socket, asio::buffer(bytes));
  std::string answers;
  beast::error_code ended;
  asio::read(socket, asio::dynamic_buffer(answers), ended);
  EXPECT_EQ(ended, asio::error::eof);
  return answers;
}

TEST_F(HttpTest, NoByteOfABodyWhoseEndIsUnclearIsTakenForARequest) {
  const std::string smuggled = "POST /api/stop HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::string length = "Content-Length: " + std::to_string(smuggled.size()) + "\r\n";
  const std::pair<std::string, std::string> cases[] = {
      {"Transfer-Encoding: gzip\r\n", "501"},
      {"Transfer-Encoding: gzip, chunked\r\n", "501"},
      {"Transfer-Encoding: gzip\r\nTransfer-Encoding: gzip\r\n", "501"},
      {"Transfer-Encoding: gzip\r\n" + length, "400"},
      {length + "Transfer-Encoding: gzip\r\n", "400"},
      {length + "Transfer-Encoding: chunked\r\n", "400"},
      {"Transfer-Encoding: chunked\r\n" + length, "400"}};
  for (const auto& [framing, status] : cases) {
    const std::string answers = all_answers(
        connect(), "POST /api/nothing HTTP/1.1\r\nHost: localhost\r\n" + framing + "\r\n" + smuggled);
    EXPECT_THAT(answers, testing::StartsWith("HTTP/1.1 " + status)) << framing;
    EXPECT_THAT(answers, HasSubstr("application/problem+json")) << framing;
    EXPECT_THAT(answers, HasSubstr("Connection: close")) << framing;
    EXPECT_EQ(answers.find("Connection: close"), answers.rfind("Connection: close")) << framing << answers;
  }
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(HttpTest, ABodyInChunksIsRead) {
  const Answered answered = post_raw(
      "POST /api/login HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: "
      "chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n");
  EXPECT_EQ(answered.status, 422u) << answered.body;
}

TEST_F(HttpTest, ARequestNamesOneHost) {
  for (const std::string hosts : {"", "Host: localhost\r\nHost: localhost\r\n"}) {
    for (const std::string line : {"GET /api/status", "POST /api/stop"}) {
      const Answered answered = post_raw(line + " HTTP/1.1\r\n" + hosts + "\r\n");
      EXPECT_EQ(answered.status, 400u) << line;
      EXPECT_EQ(answered.problem()["code"], "MALFORMED") << line;
    }
  }
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(HttpTest, AnEncodedSlashReachesNoRoute) {
  for (const std::string target : {"/api%2fstatus", "/api%2Fstatus", "/api/motors%2f3", "/api%5cstatus",
                                   "/api/status%00", "/index.html%00", "/%2findex.html"}) {
    const Answered answered = get(target);
    EXPECT_EQ(answered.status, 400u) << target;
    EXPECT_EQ(answered.problem()["code"], "MALFORMED") << target;
  }
  EXPECT_EQ(post("/api%2fstop").status, 400u);
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(HttpTest, APageOfAnotherOriginChangesNothing) {
  for (const std::string& origin :
       {std::string("http://evil.example"), "https://" + host(), std::string("null")}) {
    Request request{http::verb::post, "/api/stop", 11};
    request.set(http::field::origin, origin);
    const Answered answered = send(request);
    EXPECT_EQ(answered.status, 403u) << origin;
    EXPECT_EQ(answered.problem()["code"], "ORIGIN");
  }
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(HttpTest, ThePageOfThisServerMay) {
  Request request{http::verb::post, "/api/stop", 11};
  request.set(http::field::origin, "http://" + host());
  EXPECT_EQ(send(request).status, 200u);
  EXPECT_EQ(channel_->stops.load(), 1u);
}

TEST_F(HttpTest, ARequestForAnotherHostIsRefused) {
  for (const std::string name :
       {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "[::1", "localhost.", ""}) {
    const Answered answered = post_raw("GET /api/status HTTP/1.1\r\nHost: " + name + "\r\n\r\n");
    EXPECT_EQ(answered.status, 403u) << name;
    EXPECT_EQ(answered.problem()["code"], "HOST");
  }
  for (const std::string name : {"localhost", "localhost:1", "[::1]:8080", "127.0.0.1"}) {
    EXPECT_EQ(post_raw("GET /api/status HTTP/1.1\r\nHost: " + name + "\r\n\r\n").status, 200u) << name;
  }
}

TEST_F(HttpTest, EveryAnswerCarriesTheSecurityHeadersAndNoCors) {
  for (const std::string target : {"/", "/api/status", "/api/nothing", "/nothing"}) {
    const Answered answered = get(target);
    EXPECT_THAT(std::string(answered.headers["Content-Security-Policy"]),
                testing::AllOf(HasSubstr("default-src 'self'"), HasSubstr("'wasm-unsafe-eval'")))
        << target;
    EXPECT_EQ(answered.headers["X-Content-Type-Options"], "nosniff") << target;
    EXPECT_EQ(answered.headers.count("Access-Control-Allow-Origin"), 0u) << target;
  }
}

TEST_F(HttpTest, HeadHasTheHeaderOfGetAndNoBody) {
  tcp::socket socket = connect();
  http::request<http::empty_body> request{http::verb::head, "/", 11};
  request.set(http::field::host, host());
  http::write(socket, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.skip(true);
  http::read(socket, buffer, parser);
  EXPECT_EQ(parser.get()[http::field::content_length], "22");
  EXPECT_EQ(parser.get().result_int(), 200u);
}

TEST_F(HttpTest, AConnectionServesManyRequests) {
  tcp::socket socket = connect();
  for (int i = 0; i < 3; ++i) {
    Request request{http::verb::get, "/api/status", 11};
    request.set(http::field::host, host());
    http::write(socket, request);
    EXPECT_EQ(read(socket).status, 200u);
  }
}

TEST_F(HttpTest, WithoutAKernelStatusAnswersAndTheRestSaysWhy) {
  const json status = json::parse(get("/api/status").body);
  EXPECT_EQ(status["connected"], false);
  EXPECT_EQ(status["mode"], "INIT");
  for (const std::string target : {"/api/reset", "/api/motors/3/enable"}) {
    const Answered answered = post(target);
    EXPECT_EQ(answered.status, 503u) << target;
    EXPECT_EQ(answered.problem()["code"], "NO_KERNEL") << target;
  }
  EXPECT_EQ(get("/api/motors").status, 503u);
  EXPECT_EQ(post("/api/proposals", R"({"slot":3,"target":1})").status, 503u);
}

TEST_F(HttpTest, StopIsAnsweredWithoutAKernel) {
  const Answered answered = post("/api/stop");
  EXPECT_EQ(answered.status, 200u);
  EXPECT_TRUE(json::parse(answered.body)["verdict"].is_null());
  EXPECT_EQ(channel_->stops.load(), 1u);
}

TEST_F(HttpTest, StopIsAnsweredWhileOtherRequestsHang) {
  show(test::ready_view());
  auto hanging = std::async(std::launch::async, [this] { return post("/api/reset"); });
  const Command asked = next_command();
  tcp::socket half_open = connect();
  asio::write(half_open, asio::buffer(std::string("POST /api/proposals HTTP/1.1\r\n")));
  auto stopping = std::async(std::launch::async, [this] { return post("/api/stop"); });
  while (channel_->stops.load() == 0) {
    std::this_thread::yield();
  }
  answer(StopAnswer{1, ILK_VERDICT_ACCEPTED, 5});
  const Answered stopped = stopping.get();
  EXPECT_EQ(stopped.status, 200u);
  EXPECT_EQ(json::parse(stopped.body)["verdict"], "ACCEPTED");
  EXPECT_EQ(hanging.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  answer(KernelResponse{std::get<KernelCall>(asked).call_id, ILK_VERDICT_ACCEPTED, 6});
  EXPECT_EQ(hanging.get().status, 200u);
}

TEST_F(HttpTest, AStopThatTheDoorDoesNotRecogniseIsObeyedAndAnsweredAllTheSame) {
  const std::string end = " HTTP/1.1\r\nHost: " + host() + "\r\nContent-Length: 0\r\n\r\n";
  EXPECT_EQ(post_raw("POST /api/%73top" + end).status, 200u);
  EXPECT_EQ(channel_->stops.load(), 1u);
  tcp::socket socket = connect();
  asio::write(socket,
              asio::buffer("GET /api/status HTTP/1.1\r\nHost: " + host() + "\r\n\r\nPOST /api/stop" + end));
  beast::flat_buffer buffer;
  for (int i = 0; i < 2; ++i) {
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    EXPECT_EQ(response.result_int(), 200u);
  }
  EXPECT_EQ(channel_->stops.load(), 2u);
}

TEST_F(HttpTest, StopAbortsEveryOpenProposal) {
  show(test::ready_view());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  show(ControlView{});
  ASSERT_EQ(post("/api/stop").status, 200u);
  EXPECT_EQ(json::parse(get("/api/proposals/1").body)["state"], "aborted");
}

TEST_F(HttpTest, AnOrderCarriesTheStopsThatItsAuthorHasSeen) {
  show(test::ready_view());
  show(ControlView{});
  (void)post("/api/stop");
  show(test::ready_view());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  EXPECT_EQ(std::get<Approval>(next_command()).stops, 1u);
}

TEST_F(HttpTest, AVerdictOfTheKernelIsTheAnswer) {
  show(test::ready_view());
  auto asking = std::async(std::launch::async, [this] { return post("/api/motors/3/clear-fault"); });
  const auto ask = std::get<KernelCall>(next_command());
  EXPECT_EQ(ask.kind, static_cast<std::uint32_t>(ILK_REQUEST_CLEAR_FAULT));
  EXPECT_EQ(ask.slot, insertion);
  answer(KernelResponse{ask.call_id, ILK_VERDICT_MODE, 6});
  const Answered answered = asking.get();
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "MODE");
  EXPECT_FALSE(answered.problem()["next_step"].get<std::string>().empty());
}

TEST_F(HttpTest, ALostAnswerSaysThatTheKernelDidNotAnswer) {
  show(test::ready_view());
  auto asking = std::async(std::launch::async, [this] { return post("/api/reset"); });
  answer(KernelResponse{std::get<KernelCall>(next_command()).call_id, std::nullopt, 0});
  EXPECT_EQ(asking.get().status, 503u);
}

TEST_F(HttpTest, AProposalIsMadeShownAndAborted) {
  show(test::ready_view());
  const Answered made = post("/api/proposals", R"({"slot":3,"target":20,"drive":9000})");
  ASSERT_EQ(made.status, 201u);
  const json proposal = json::parse(made.body);
  EXPECT_EQ(proposal["state"], "approved");
  EXPECT_EQ(proposal["target_counts"], 945);
  EXPECT_EQ(next_task().work.as<MoveTask>().drive, 9000u);
  EXPECT_EQ(json::parse(get("/api/motors/3").body)["setpoint_counts"], 945);
  EXPECT_EQ(json::parse(get("/api/proposals").body).size(), 1u);
  EXPECT_EQ(json::parse(post("/api/proposals/1/abort").body)["state"], "aborted");
  EXPECT_EQ(std::get<Cancel>(next_command()).task, 1u);
  EXPECT_EQ(post("/api/proposals/1/abort").problem()["code"], "ENDED");
  EXPECT_EQ(post("/api/proposals/2/abort").status, 404u);
  EXPECT_EQ(get("/api/proposals/x").status, 404u);
}

TEST_F(HttpTest, ARefusedProposalNamesVerdictAndRange) {
  show(test::ready_view());
  const Answered answered = post("/api/proposals", R"({"slot":3,"target_counts":100000})");
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "RANGE");
  EXPECT_THAT(answered.problem()["expected"].get<std::string>(), HasSubstr("1638"));
}

TEST_F(HttpTest, RealHardwareHasNoBench) {
  EXPECT_EQ(get("/api/bench").problem()["code"], "NO_BENCH");
  EXPECT_EQ(post("/api/bench/pedal", R"({"pressed":true})").status, 404u);
}

TEST_F(HttpTest, TheStreamIsAWebSocket) {
  const Answered answered = get("/api/stream");
  EXPECT_EQ(answered.status, 426u);
  EXPECT_EQ(answered.problem()["code"], "UPGRADE_REQUIRED");
  Request older{http::verb::get, "/api/stream", 11};
  older.set(http::field::upgrade, "websocket");
  older.set(http::field::connection, "Upgrade");
  older.set("Sec-WebSocket-Version", "8");
  older.set("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==");
  const Answered refused = send(std::move(older));
  EXPECT_EQ(refused.status, 426u);
  EXPECT_EQ(refused.problem()["code"], "UPGRADE_REQUIRED");
  EXPECT_EQ(refused.headers["Sec-WebSocket-Version"], "13");
}

TEST_F(HttpTest, TheStreamShowsTheState) {
  show(test::ready_view());
  auto stream = open_stream();
  const std::optional<test::StreamMessage> state = stream.next();
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->text);
  EXPECT_EQ(state->data.size(), stream_bytes);
}

TEST_F(HttpTest, TheStreamTellsOfProposalsAndEventsInOrder) {
  show(test::ready_view());
  auto stream = open_stream();
  ASSERT_TRUE(stream.next());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  answer(ilk_event_t{0, ILK_EVENT_MODE, 12, {ILK_MODE_READY, ILK_MODE_MOTION, 0, 0}});
  std::vector<std::string> texts;
  while (texts.size() < 4) {
    const json message = stream.next_text();
    if (message["type"] == "proposal") {
      texts.push_back(message["state"]);
    } else if (message["type"] == "event") {
      texts.push_back(message["kind"]);
    }
  }
  EXPECT_THAT(texts, testing::ElementsAre("drafted", "checked", "approved", "mode"));
}

TEST_F(HttpTest, TheStreamRefusesAPageOfAnotherOrigin) {
  test::StreamClient stream(connect());
  EXPECT_EQ(stream.open(host(), "", "http://evil.example"), 403u);
}

TEST_F(HttpTest, AClientThatTalksToTheStreamIsToldSo) {
  auto stream = open_stream();
  stream.send("hello");
  constexpr unsigned policy_error = 1008;
  EXPECT_EQ(stream.close_code(), policy_error);
}

TEST_F(HttpTest, AClientThatCannotKeepUpIsDroppedNotItsMessages) {
  auto stream = open_stream();
  ASSERT_TRUE(stream.next());
  in_network([this] {
    for (std::size_t i = 0; i <= Broadcaster::backlog; ++i) {
      api_.stream().send_text({{"number", i}});
    }
  });
  std::size_t expected = 0;
  while (const std::optional<test::StreamMessage> message = stream.next()) {
    if (message->text) {
      EXPECT_EQ(json::parse(message->data)["number"], expected++);
    }
  }
  EXPECT_LE(expected, Broadcaster::backlog);
  EXPECT_EQ(get("/api/status").status, 200u);
}

TEST_F(HttpTest, ClosedStreamsMakeRoomForOthers) {
  for (std::size_t i = 0; i < 2 * Broadcaster::capacity; ++i) {
    open_stream().close();
  }
  for (bool empty = false; !empty;) {
    in_network([&] { empty = api_.stream().empty(); });
  }
  EXPECT_TRUE(open_stream().next());
}

TEST_F(HttpTest, TooManyStreamsAreRefusedByName) {
  std::vector<test::StreamClient> streams;
  for (std::size_t i = 0; i < Broadcaster::capacity; ++i) {
    if (i % Broadcaster::session_capacity == 0) {
      log_in("edna");
    }
    streams.push_back(open_stream());
  }
  log_in("ada");
  EXPECT_EQ(status_of_one_more_stream(), 503u);
}

TEST_F(HttpTest, IdleConnectionsMakeRoomForNewOnes) {
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < Server::capacity + 10; ++i) {
    idle.push_back(connect());
  }
  EXPECT_EQ(post("/api/stop").status, 200u);
}

TEST_F(HttpTest, APortThatIsBusyIsNamed) {
  Server second(network_.get_executor(), network_.get_executor(), api_, *channel_, StaticFiles({}));
  const auto listening = second.door().listen({"127.0.0.1", server_.port()});
  ASSERT_FALSE(listening);
  EXPECT_THAT(listening.error(), HasSubstr(std::to_string(server_.port())));
  EXPECT_THAT(listening.error(), HasSubstr("--port"));
}

TEST_F(HttpTest, NoOtherMachineIsLetIn) {
  for (const std::string address : {"0.0.0.0", "::", "192.0.2.1", "example"}) {
    Server server(network_.get_executor(), network_.get_executor(), api_, *channel_, StaticFiles({}));
    const auto listening = server.door().listen({address, 0});
    ASSERT_FALSE(listening) << address;
    EXPECT_THAT(listening.error(), HasSubstr(address));
    EXPECT_THAT(listening.error(), HasSubstr("127.0.0.1"));
  }
}

TEST_F(HttpTest, WhatEndsAHoldAMotionOrAConnectionIsNeverTooLate) {
  const auto later = std::chrono::steady_clock::now() + std::chrono::hours(1);
  channel_->last_stop.store(later.time_since_epoch());
  const auto code_of = [&](http::verb method, const std::string& path, const std::string& body) {
    Request request{method, path, 11};
    request.body() = body;
    const Answered answered = send(std::move(request));
    return answered.status < 300 ? json("done") : answered.problem()["code"];
  };
  const std::vector<std::tuple<http::verb, std::string, std::string>> begins{
      {http::verb::post, "/api/bench/pedal", R"({"pressed":true})"},
      {http::verb::post, "/api/bench/pedal", R"({"pressed":0})"},
      {http::verb::post, "/api/bench/pedal", "{"},
      {http::verb::post, "/api/bench/estop", R"({"pulled":false})"},
      {http::verb::post, "/api/bench/hand", R"({"newtons":5})"},
      {http::verb::put, "/api/mode", R"({"mode":"home"})"},
      {http::verb::post, "/api/jog", R"({"slot":3,"direction":"increasing"})"},
      {http::verb::put, "/api/jog/1", ""}};
  for (const auto& [method, path, body] : begins) {
    EXPECT_EQ(code_of(method, path, body), "LATE") << path << body;
  }
  const std::vector<std::tuple<http::verb, std::string, std::string>> ends{
      {http::verb::post, "/api/bench/pedal", R"({"pressed":false})"},
      {http::verb::post, "/api/bench/estop", R"({"pulled":true})"},
      {http::verb::post, "/api/bench/hand", R"({"newtons":0})"},
      {http::verb::put, "/api/mode", R"({"mode":"manual"})"},
      {http::verb::post, "/api/proposals/1/abort", ""},
      {http::verb::post, "/api/proposals/1/reject", ""},
      {http::verb::post, "/api/motors/3/disable", ""},
      {http::verb::delete_, "/api/communications/connections/9", ""},
      {http::verb::delete_, "/api/sessions/999", ""},
      {http::verb::post, "/api/control/release", ""},
      {http::verb::post, "/api/authority/release", ""},
      {http::verb::post, "/api/logout", ""}};
  for (const auto& [method, path, body] : ends) {
    EXPECT_NE(code_of(method, path, body), "LATE") << path;
  }
}

TEST(Bench, ARenewalIsRefusedForTheReasonForWhichThePedalCameUp) {
  asio::io_context network;
  Bench bench(network.get_executor(), "/nonexistent/bench");
  const auto pedal = [&](std::uint32_t session, const json& fields) {
    Reply reply = fail(Problem{});
    asio::co_spawn(network, bench.command("pedal", fields, ControlView{}, session),
                   [&](const std::exception_ptr&, Reply came) { reply = std::move(came); });
    network.restart();
    network.run();
    return reply.error();
  };
  const json press{{"pressed", true}};
  const json renewal{{"pressed", true}, {"renew", true}};
  EXPECT_THAT(pedal(1, renewal).detail, HasSubstr("Nobody has pressed"));
  EXPECT_EQ(pedal(1, press).code, "NO_BENCH") << "there is none, but somebody holds on";
  (void)pedal(2, {{"pressed", false}});
  const Problem lapsed = pedal(1, renewal);
  EXPECT_EQ(lapsed.code, "PEDAL_LAPSED");
  EXPECT_THAT(lapsed.detail, HasSubstr("Session 2 released it."));
  (void)pedal(1, press);
  asio::co_spawn(network, bench.release_pedal("Its hold was not renewed for 500 ms."), asio::detached);
  network.restart();
  network.run();
  EXPECT_THAT(pedal(1, renewal).detail, HasSubstr("not renewed for 500 ms"));
}

TEST(Bench, SaysThatTheSimulatedHardwareIsAway) {
  asio::io_context network;
  BenchClient bench(network.get_executor(), "/nonexistent/bench");
  std::optional<BenchReply> reply;
  asio::co_spawn(network, bench.command({{"command", "status"}}),
                 [&](const std::exception_ptr&, BenchReply came) { reply = std::move(came); });
  network.run();
  ASSERT_TRUE(reply);
  ASSERT_FALSE(*reply);
  EXPECT_EQ(reply->error().kind, BenchError::Kind::unreachable);
  EXPECT_THAT(reply->error().detail, HasSubstr("/nonexistent/bench"));
}

}  // namespace
}  // namespace interlock::web
