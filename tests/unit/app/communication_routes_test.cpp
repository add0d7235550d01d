#include "http_fixture.hpp"

namespace interlock::web {
namespace {

class CommunicationRoutesTest : public HttpTest {
 protected:
  json connections() { return json::parse(get("/api/communications").body); }

  /** Until as many consoles are listed, since a stream opens and closes in its own time. */
  json consoles(std::size_t count) {
    for (;;) {
      json found = json::array();
      for (const json& each : connections()) {
        if (each["type"] == "console") {
          found.push_back(each);
        }
      }
      if (found.size() == count) {
        return found;
      }
    }
  }
};

TEST_F(CommunicationRoutesTest, TheKernelIsListedWhetherConnectedOrNot) {
  EXPECT_EQ(connections()[0]["type"], "kernel");
  EXPECT_EQ(connections()[0]["connected"], false);
  EXPECT_TRUE(connections()[0]["since"].is_null());
  show(test::ready_view());
  EXPECT_EQ(connections()[0]["connected"], true);
  EXPECT_TRUE(connections()[0]["since"].is_string());
  EXPECT_TRUE(connections()[0]["id"].is_null());
  EXPECT_EQ(connections().size(), 1u) << "real hardware has no bench";
}

TEST_F(CommunicationRoutesTest, EachConsoleIsListedWithPeerUserAndPort) {
  auto first = open_stream();
  consoles(1);
  auto second = open_stream();
  const json found = consoles(2);
  EXPECT_LT(found[0]["id"], found[1]["id"]);
  EXPECT_EQ(found[0]["client"], "127.0.0.1:" + std::to_string(first.local_port()));
  EXPECT_EQ(found[0]["port"], server_.port());
  EXPECT_FALSE(found[0]["user"].get<std::string>().empty());
  EXPECT_FALSE(found[0]["since"].get<std::string>().empty());
}

TEST_F(CommunicationRoutesTest, AConsoleIsToldOfAnotherThatComesAndGoes) {
  auto first = open_stream();
  consoles(1);
  auto second = open_stream();
  const json came = first.next_text("connection");
  EXPECT_EQ(came["change"], "opened");
  EXPECT_EQ(came["connection"], "console");
  EXPECT_EQ(came["client"], "127.0.0.1:" + std::to_string(second.local_port()));
  EXPECT_EQ(came["user"], "edna");
  second.close();
  const json went = first.next_text("connection");
  EXPECT_EQ(went["change"], "closed");
  EXPECT_EQ(went["id"], came["id"]);
}

TEST_F(CommunicationRoutesTest, ADisconnectedConsoleIsGoneAndTheOtherStays) {
  auto first = open_stream();
  const json gone = consoles(1)[0]["id"];
  auto second = open_stream();
  consoles(2);
  ASSERT_EQ(put("/api/communications/disconnect", json{{"id", gone}}.dump()).status, 200u);
  EXPECT_NE(consoles(1)[0]["id"], gone);
  const std::vector<json> recorded = audit("connection");
  ASSERT_EQ(recorded.size(), 1u);
  EXPECT_EQ(recorded[0]["action"], "disconnect");
  EXPECT_EQ(recorded[0]["user"], "edna");
  while (first.next()) {
  }
  EXPECT_TRUE(second.next());
  EXPECT_EQ(put("/api/communications/disconnect", json{{"id", gone}}.dump()).status, 404u);
}

TEST_F(CommunicationRoutesTest, AWrongNumberIsNamedAndNobodyIsDisconnected) {
  auto stream = open_stream();
  consoles(1);
  for (const std::string body :
       {"{}", R"({"id":0})", R"({"id":"x"})", R"({"id":null})", R"({"id":1,"all":true})"}) {
    EXPECT_EQ(put("/api/communications/disconnect", body).status, 422u) << body;
  }
  EXPECT_EQ(put("/api/communications/disconnect", "{").status, 400u);
  EXPECT_EQ(put("/api/communications/disconnect", R"({"id":4294967295})").status, 404u);
  consoles(1);
}

}  // namespace
}  // namespace interlock::web
