#include "http/static_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.hpp"

namespace interlock::web {
namespace {

namespace http = boost::beast::http;

class StaticFilesTest : public testing::Test {
 protected:
  StaticFilesTest() {
    std::filesystem::create_directories(root() / "assets");
    write(root() / "index.html", "<title>console</title>");
    write(root() / "assets" / "app.js", "1");
    write(root() / "assets" / "core.wasm", "2");
    write(root() / "a b.txt", "3");
    write(folder_.path() / "secret", "never");
    std::filesystem::create_symlink(folder_.path() / "secret", root() / "link");
  }

  [[nodiscard]] std::filesystem::path root() const { return folder_.path() / "web"; }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  [[nodiscard]] Response get(const std::string& target, http::verb method = http::verb::get) const {
    return StaticFiles(root()).serve(Request{method, target, 11});
  }

  test::TemporaryFolder folder_;
};

TEST_F(StaticFilesTest, ServesTheIndexAtTheRoot) {
  const Response response = get("/");
  EXPECT_EQ(response.result(), Status::ok);
  EXPECT_EQ(response.body(), "<title>console</title>");
  EXPECT_EQ(response[http::field::content_type], "text/html; charset=utf-8");
}

TEST_F(StaticFilesTest, NamesTheTypeOfEachFile) {
  EXPECT_EQ(get("/assets/app.js?v=1")[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/assets/core.wasm")[http::field::content_type], "application/wasm");
}

TEST_F(StaticFilesTest, DecodesPaths) { EXPECT_EQ(get("/a%20b.txt").body(), "3"); }

TEST_F(StaticFilesTest, NeverLeavesItsFolder) {
  for (const std::string target :
       {"/../secret", "/assets/../../secret", "/%2e%2e/secret", "/..%2fsecret", "//../secret", "/link",
        "/index.html%00.txt", "/%zz", "/%2", "relative", "/assets", "/assets/"}) {
    EXPECT_EQ(get(target).result(), Status::not_found) << target;
  }
}

TEST_F(StaticFilesTest, OnlyReads) {
  const Response response = get("/index.html", http::verb::post);
  EXPECT_EQ(response.result(), Status::method_not_allowed);
  EXPECT_EQ(response[http::field::allow], "GET, HEAD");
}

TEST_F(StaticFilesTest, SaysHowToBringTheConsole) {
  const Response response = StaticFiles({}).serve(Request{http::verb::get, "/", 11});
  EXPECT_EQ(response.result(), Status::not_found);
  EXPECT_NE(response.body().find("--web"), std::string::npos);
}

}  // namespace
}  // namespace interlock::web
