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
    std::filesystem::create_directories(documents() / "code");
    write(documents() / "index.html", "<title>documents</title>");
    write(documents() / "code" / "a.html", "4");
    std::filesystem::create_symlink(folder_.path() / "secret", root() / "link");
  }

  [[nodiscard]] std::filesystem::path root() const { return folder_.path() / "web"; }
  [[nodiscard]] std::filesystem::path documents() const { return folder_.path() / "site"; }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  [[nodiscard]] Response get(const std::string& target, http::verb method = http::verb::get) const {
    return StaticFiles(root(), documents()).serve(Request{method, target, 11});
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
        "/index.html%00.txt", "/%zz", "/%2", "relative", "/assets", "/assets/", "/docs/../secret",
        "/docs/%2e%2e/web/index.html", "/docs/code/", "/docsindex.html"}) {
    EXPECT_EQ(get(target).result(), Status::not_found) << target;
  }
}

TEST_F(StaticFilesTest, ServesTheDocumentsBelowTheirOwnPath) {
  EXPECT_EQ(get("/docs/").body(), "<title>documents</title>");
  EXPECT_EQ(get("/docs/code/a.html").body(), "4");
  EXPECT_EQ(get("/docs/assets/app.js").result(), Status::not_found);
  EXPECT_EQ(get("/code/a.html").result(), Status::not_found);
  const Response moved = get("/docs");
  EXPECT_EQ(moved.result(), Status::permanent_redirect);
  EXPECT_EQ(moved[http::field::location], "/docs/");
}

TEST_F(StaticFilesTest, SaysHowToBringTheDocuments) {
  for (const std::string target : {"/docs", "/docs/", "/docs/index.html"}) {
    const Response response = StaticFiles(root()).serve(Request{http::verb::get, target, 11});
    EXPECT_EQ(response.result(), Status::not_found) << target;
    EXPECT_NE(response.body().find("make docs"), std::string::npos) << target;
  }
}

TEST_F(StaticFilesTest, OnlyReads) {
  for (const std::string target : {"/index.html", "/docs/index.html"}) {
    const Response response = get(target, http::verb::post);
    EXPECT_EQ(response.result(), Status::method_not_allowed) << target;
    EXPECT_EQ(response[http::field::allow], "GET, HEAD") << target;
  }
}

TEST_F(StaticFilesTest, SaysHowToBringTheConsole) {
  const Response response = StaticFiles({}).serve(Request{http::verb::get, "/", 11});
  EXPECT_EQ(response.result(), Status::not_found);
  EXPECT_NE(response.body().find("--web"), std::string::npos);
}

}  // namespace
}  // namespace interlock::web
